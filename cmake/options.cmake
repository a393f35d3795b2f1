# Compiler options of every Firn target, as one interface target.
add_library(firn_options INTERFACE)
target_compile_features(firn_options INTERFACE cxx_std_20)
target_include_directories(firn_options INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_compile_options(firn_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  # The same bits from every compiler: a*b+c is fused only where the source says so.
  -ffp-contract=off
  $<$<BOOL:${FIRN_WERROR}>:-Werror>)

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # Highway 1.0.3 falls back to one-lane SCALAR code on plain x86-64. SSE4 (every x86-64 processor since 2008) is the
  # baseline here; wider targets are chosen at run time. Its SSE4 and AVX2 want AES unless told otherwise.
  target_compile_options(firn_options INTERFACE -march=x86-64-v2)
endif()
set(FIRN_DISABLED_TARGETS "HWY_AVX3_DL|HWY_SSSE3|HWY_EMU128|HWY_SCALAR")
if(FIRN_SANITIZE)
  # Two targets are what the sanitizers run on; a third would only lengthen their build.
  string(APPEND FIRN_DISABLED_TARGETS "|HWY_AVX3")
endif()
target_compile_definitions(firn_options INTERFACE
  HWY_DISABLE_PCLMUL_AES "HWY_DISABLED_TARGETS=(${FIRN_DISABLED_TARGETS})")

if(FIRN_SANITIZE)
  # The preset does not treat warnings as errors: g++ 12 takes instrumented code for uninitialised where it is not.
  target_compile_options(firn_options INTERFACE
    -O1 -g1 -fno-omit-frame-pointer -fsanitize=${FIRN_SANITIZE} -fno-sanitize-recover=all)
  target_link_options(firn_options INTERFACE -fsanitize=${FIRN_SANITIZE})
endif()
