# Libraries from the system's packages; docs/dependencies.md says why each is here. Nothing is downloaded.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(embree 3 REQUIRED)
find_package(GTest REQUIRED)
pkg_check_modules(highway REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(muparser REQUIRED IMPORTED_TARGET muparser)
pkg_check_modules(cli11 REQUIRED IMPORTED_TARGET CLI11)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
# `hdf5` alone silently becomes the MPI build where both are installed.
pkg_check_modules(hdf5 REQUIRED IMPORTED_TARGET hdf5-serial)
pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(glfw REQUIRED IMPORTED_TARGET glfw3)
pkg_check_modules(imgui REQUIRED IMPORTED_TARGET imgui)

pkg_check_modules(assimp REQUIRED IMPORTED_TARGET assimp)

# Debian's FindOpenVDB.cmake asks for Boost and OpenEXR too, which Firn has no use for. Imath has OpenVDB's half floats.
find_path(FIRN_OPENVDB_INCLUDE openvdb/openvdb.h REQUIRED)
find_library(FIRN_OPENVDB_LIBRARY openvdb REQUIRED)
pkg_check_modules(imath REQUIRED IMPORTED_TARGET Imath)
mark_as_advanced(FIRN_OPENVDB_INCLUDE FIRN_OPENVDB_LIBRARY)
add_library(openvdb UNKNOWN IMPORTED)
set_target_properties(openvdb PROPERTIES
  IMPORTED_LOCATION ${FIRN_OPENVDB_LIBRARY}
  INTERFACE_INCLUDE_DIRECTORIES ${FIRN_OPENVDB_INCLUDE}
  INTERFACE_LINK_LIBRARIES "TBB::tbb;PkgConfig::imath")
