# Every third party, found once, as imported (so system-header) targets. Traps are named where they bite.
include(binpick_dependencies)

if(BINPICK_WITH_SIM)
  find_package(CLI11 REQUIRED)

  # CMake's own FindBullet finds only the single-precision libraries, and mixing precisions is an ABI error.
  pkg_check_modules(BULLET REQUIRED IMPORTED_TARGET bullet-float64)
  add_library(binpick_bullet INTERFACE)
  target_link_libraries(binpick_bullet INTERFACE PkgConfig::BULLET)

  pkg_check_modules(OSMESA REQUIRED IMPORTED_TARGET osmesa)
  find_package(embree 3 REQUIRED)
  find_package(OpenCV 4 REQUIRED COMPONENTS core imgproc calib3d aruco)

  # Peers of the benchmark only (tools/bench/peers): a single module each, and neither need be there.
  find_package(OpenCV 4 QUIET COMPONENTS core surface_matching)
  if(TARGET opencv_surface_matching)
    set(BINPICK_OPENCV_SURFACE_MATCHING opencv_surface_matching)
  endif()
  find_library(BINPICK_PCL_REGISTRATION NAMES pcl_registration)

  pkg_check_modules(TINYXML2 REQUIRED IMPORTED_TARGET tinyxml2)

  find_package(SQLite3 REQUIRED)

  find_package(meshoptimizer REQUIRED)  # meshes of replays, made small
  find_package(GIF 5 REQUIRED)

  # Scripts that report pages carry; three.js is of before it became modules only, which a page opened from disk cannot
  # load.
  find_file(BINPICK_CHART_JS chart.min.js PATHS /usr/share/javascript/chart.js NO_DEFAULT_PATH)
  find_file(BINPICK_THREE_JS three.min.js
            PATHS /usr/share/javascript/three /usr/share/javascript/three/build NO_DEFAULT_PATH)
  find_file(BINPICK_ORBIT_CONTROLS_JS OrbitControls.js
            PATHS /usr/share/javascript/three/examples/js/controls NO_DEFAULT_PATH)
  if(NOT BINPICK_CHART_JS OR NOT BINPICK_THREE_JS OR NOT BINPICK_ORBIT_CONTROLS_JS)
    message(FATAL_ERROR "Report pages carry Chart.js 3 and three.js r111: install libjs-chart.js and libjs-three "
                        "(tools/setup does), or set BINPICK_CHART_JS, BINPICK_THREE_JS and BINPICK_ORBIT_CONTROLS_JS")
  endif()

  pkg_check_modules(URDFDOM REQUIRED IMPORTED_TARGET urdfdom)

  # Not find_package(ompl): its variables name a folder that does not exist and ODE, which only another planner needs.
  find_path(OMPL_INCLUDE_DIR ompl/config.h PATH_SUFFIXES ompl-1.5 ompl-1.6 REQUIRED)
  find_library(OMPL_LIBRARY NAMES ompl REQUIRED)
  add_library(binpick_ompl INTERFACE)
  target_include_directories(binpick_ompl SYSTEM INTERFACE ${OMPL_INCLUDE_DIR})
  target_link_libraries(binpick_ompl INTERFACE ${OMPL_LIBRARY})

  find_path(KDL_INCLUDE_DIR kdl/chain.hpp REQUIRED)
  find_library(KDL_LIBRARY NAMES orocos-kdl REQUIRED)
  add_library(binpick_kdl INTERFACE)
  target_include_directories(binpick_kdl SYSTEM INTERFACE ${KDL_INCLUDE_DIR})
  target_link_libraries(binpick_kdl INTERFACE ${KDL_LIBRARY})
endif()

if(BINPICK_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
