# Every third party, found once, as imported (so system-header) targets. Traps are named where they bite.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)

pkg_check_modules(YAMLCPP REQUIRED IMPORTED_TARGET yaml-cpp)
find_package(nlohmann_json REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(assimp REQUIRED)
find_package(PNG REQUIRED)
find_package(TIFF REQUIRED)

# CMake's own FindBullet finds only the single-precision libraries, and mixing precisions is an ABI error.
pkg_check_modules(BULLET REQUIRED IMPORTED_TARGET bullet-float64)
add_library(binpick_bullet INTERFACE)
target_link_libraries(binpick_bullet INTERFACE PkgConfig::BULLET)

pkg_check_modules(OSMESA REQUIRED IMPORTED_TARGET osmesa)
find_package(embree 3 REQUIRED)

# Single OpenCV modules, never ${OpenCV_LIBS}: imgcodecs, videoio and ximgproc pull GPL libraries in Debian.
find_package(OpenCV 4 REQUIRED COMPONENTS core imgproc calib3d)
# Peers of the benchmark only (tools/bench/peers): a single module each, and neither need be there.
find_package(OpenCV 4 QUIET COMPONENTS core surface_matching)
if(TARGET opencv_surface_matching)
  set(BINPICK_OPENCV_SURFACE_MATCHING opencv_surface_matching)
endif()
find_library(BINPICK_PCL_REGISTRATION NAMES pcl_registration)

# Plain PCL libraries by name. Neither ${PCL_LIBRARIES} nor PCL's own imported targets: both drag VTK, Qt and MPI in even
# for the core components (and with VTK comes GDAL, Poppler and x264).
pkg_check_modules(PCL REQUIRED pcl_common>=1.12)
add_library(binpick_pcl INTERFACE)
target_include_directories(binpick_pcl SYSTEM INTERFACE ${PCL_INCLUDE_DIRS})
foreach(module features search kdtree common)
  find_library(PCL_${module}_LIBRARY NAMES pcl_${module} REQUIRED)
  target_link_libraries(binpick_pcl INTERFACE ${PCL_${module}_LIBRARY})
endforeach()

find_library(QHULL_R_LIBRARY NAMES qhull_r REQUIRED)
find_path(QHULL_INCLUDE_DIR libqhull_r/libqhull_r.h REQUIRED)
add_library(binpick_qhull INTERFACE)
target_include_directories(binpick_qhull SYSTEM INTERFACE ${QHULL_INCLUDE_DIR})
target_link_libraries(binpick_qhull INTERFACE ${QHULL_R_LIBRARY})

pkg_check_modules(URDFDOM REQUIRED IMPORTED_TARGET urdfdom)

find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
add_library(binpick_random123 INTERFACE)
target_include_directories(binpick_random123 SYSTEM INTERFACE ${RANDOM123_INCLUDE_DIR})

if(BINPICK_WITH_STEP)
  find_package(OpenCASCADE REQUIRED)
  add_library(binpick_occt INTERFACE)
  target_include_directories(binpick_occt SYSTEM INTERFACE ${OpenCASCADE_INCLUDE_DIR})
  target_link_libraries(binpick_occt INTERFACE
    TKSTEP TKXSBase TKSTEPBase TKSTEPAttr TKSTL TKMesh TKFillet TKBool TKBO TKPrim TKShHealing TKTopAlgo TKGeomAlgo TKBRep
    TKGeomBase TKG3d TKG2d TKMath TKernel)
endif()

if(BINPICK_BUILD_TESTS)
  find_package(GTest REQUIRED)
  find_path(KDL_INCLUDE_DIR kdl/chain.hpp REQUIRED)
  find_library(KDL_LIBRARY NAMES orocos-kdl REQUIRED)
  add_library(binpick_kdl INTERFACE)
  target_include_directories(binpick_kdl SYSTEM INTERFACE ${KDL_INCLUDE_DIR})
  target_link_libraries(binpick_kdl INTERFACE ${KDL_LIBRARY})
endif()
