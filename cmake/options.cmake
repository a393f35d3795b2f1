# Compiler options of every Firn target, as one interface target.
add_library(firn_options INTERFACE)
target_compile_features(firn_options INTERFACE cxx_std_20)
target_include_directories(firn_options INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_compile_options(firn_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  # The same bits from every compiler: a*b+c is fused only where the source says so.
  -ffp-contract=off
  $<$<BOOL:${FIRN_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False alarms of g++ 12 about sums of std::string (its bugs 105329 and 105651).
  target_compile_options(firn_options INTERFACE
    -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
endif()

# Highway 1.0.3 falls back to one-lane SCALAR code on plain x86-64. SSE4 (every x86-64 processor since 2008) is the
# baseline here; wider targets are chosen at run time. Its SSE4 and AVX2 want AES unless told otherwise.
set(FIRN_DISABLED_TARGETS "HWY_AVX3_DL|HWY_SSSE3|HWY_EMU128|HWY_SCALAR")
set(architecture x86-64-v2)
if(FIRN_SANITIZE)
  # AVX2 alone: the same source with fewer lanes would double the time of compilation.
  string(APPEND FIRN_DISABLED_TARGETS "|HWY_AVX3")
  set(architecture x86-64-v3)
endif()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(firn_options INTERFACE -march=${architecture})
endif()
target_compile_definitions(firn_options INTERFACE
  HWY_DISABLE_PCLMUL_AES "HWY_DISABLED_TARGETS=(${FIRN_DISABLED_TARGETS})")

if(FIRN_SANITIZE)
  # The preset does not treat warnings as errors: g++ 12 takes instrumented code for uninitialised where it is not.
  target_compile_options(firn_options INTERFACE
    -O1 -g1 -Wno-maybe-uninitialized -fno-omit-frame-pointer -fsanitize=${FIRN_SANITIZE} -fno-sanitize-recover=all)
  target_link_options(firn_options INTERFACE -fsanitize=${FIRN_SANITIZE})
endif()
