# Every third-party package in one place. `./dev deps` installs them (packages.txt).
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB CONFIG REQUIRED)
find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(OpenMesh CONFIG REQUIRED)
find_package(meshoptimizer CONFIG REQUIRED)
find_package(assimp 5.2 CONFIG REQUIRED)
find_package(TinyGLTF CONFIG REQUIRED)
find_package(PNG REQUIRED)
find_package(embree 3 CONFIG REQUIRED)
pkg_check_modules(LIBAV REQUIRED IMPORTED_TARGET libavcodec libavformat libswscale libavutil)
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo)
pkg_check_modules(OSMESA REQUIRED osmesa)
# For `swarf run --tiles` alone; without it the program is the same but for that.
pkg_check_modules(MPI QUIET IMPORTED_TARGET ompi-c)
if(NOT MPI_FOUND)
  message(STATUS "Open MPI not found (libopenmpi-dev): swarf run --tiles will say so")
endif()

# By name: its .pc file asks for the development files of what it is linked with.
if(NOT TARGET swarf_lib3mf)
  find_library(LIB3MF 3MF REQUIRED)
  find_path(LIB3MF_INCLUDE Model/COM/NMR_DLLInterfaces.h PATH_SUFFIXES lib3mf REQUIRED)
  add_library(swarf_lib3mf INTERFACE IMPORTED)
  target_include_directories(swarf_lib3mf SYSTEM INTERFACE "${LIB3MF_INCLUDE}")
  target_link_libraries(swarf_lib3mf INTERFACE "${LIB3MF}")
endif()

# Libraries by name: OpenCASCADE's own configuration also asks for the development files of its viewer.
if(NOT TARGET swarf_occt)
  add_library(swarf_occt INTERFACE IMPORTED)
  target_include_directories(swarf_occt SYSTEM INTERFACE /usr/include/opencascade)
  target_link_libraries(swarf_occt INTERFACE TKSTEP TKSTEPBase TKSTEPAttr TKSTEP209 TKIGES TKXSBase TKMesh TKShHealing
    TKTopAlgo TKGeomAlgo TKBRep TKGeomBase TKG3d TKG2d TKMath TKernel)
endif()

# Debian ships FindOpenVDB.cmake outside CMake's own path; its Imath warning about Python is harmless.
list(APPEND CMAKE_MODULE_PATH "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")
set(CMAKE_FIND_PACKAGE_WARN_NO_MODULE OFF)
find_package(OpenVDB 10 REQUIRED QUIET)
