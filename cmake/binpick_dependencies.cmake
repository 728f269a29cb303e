# The third parties of core and perception, found once as imported (so system-header) targets. Included by our own build and,
# installed, by find_package(binpick): static libraries need theirs linked. Traps are named where they bite.
include(CMakeFindDependencyMacro)
find_package(PkgConfig REQUIRED)
find_dependency(Threads)
find_dependency(Eigen3 3.4 NO_MODULE)

pkg_check_modules(YAMLCPP REQUIRED IMPORTED_TARGET yaml-cpp)
find_dependency(nlohmann_json)
find_dependency(spdlog)
find_dependency(assimp)
find_dependency(PNG)
find_dependency(TIFF)

# Single OpenCV modules, never ${OpenCV_LIBS}: imgcodecs, videoio and ximgproc pull GPL libraries in Debian.
find_dependency(OpenCV 4 COMPONENTS core imgproc)

# Plain PCL libraries by name. Neither ${PCL_LIBRARIES} nor PCL's own imported targets: both drag VTK, Qt and MPI in even
# for the core components (and with VTK comes GDAL, Poppler and x264). pcl_io (PCD files, perception/cloud_io.cpp alone)
# brings VTK's own readers: BSD, and nothing under the GPL comes with them.
pkg_check_modules(PCL REQUIRED pcl_common>=1.12)
add_library(binpick_pcl INTERFACE IMPORTED)
target_include_directories(binpick_pcl SYSTEM INTERFACE ${PCL_INCLUDE_DIRS})
foreach(module io features search kdtree common)
  find_library(PCL_${module}_LIBRARY NAMES pcl_${module} REQUIRED)
  target_link_libraries(binpick_pcl INTERFACE ${PCL_${module}_LIBRARY})
endforeach()

find_library(QHULL_R_LIBRARY NAMES qhull_r REQUIRED)
find_path(QHULL_INCLUDE_DIR libqhull_r/libqhull_r.h REQUIRED)
add_library(binpick_qhull INTERFACE IMPORTED)
target_include_directories(binpick_qhull SYSTEM INTERFACE ${QHULL_INCLUDE_DIR})
target_link_libraries(binpick_qhull INTERFACE ${QHULL_R_LIBRARY})

find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
add_library(binpick_random123 INTERFACE IMPORTED)
target_include_directories(binpick_random123 SYSTEM INTERFACE ${RANDOM123_INCLUDE_DIR})

if(BINPICK_WITH_STEP)
  find_dependency(OpenCASCADE)
  add_library(binpick_occt INTERFACE IMPORTED)
  target_include_directories(binpick_occt SYSTEM INTERFACE ${OpenCASCADE_INCLUDE_DIR})
  target_link_libraries(binpick_occt INTERFACE
    TKSTEP TKXSBase TKSTEPBase TKSTEPAttr TKSTL TKMesh TKFillet TKBool TKBO TKPrim TKShHealing TKTopAlgo TKGeomAlgo TKBRep
    TKGeomBase TKG3d TKG2d TKMath TKernel)
endif()
