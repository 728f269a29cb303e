# The library for other people's projects: core and perception, their headers, and what find_package needs. Component
# `library`, so that it also comes out of a build that has the simulator.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/binpick")

install(TARGETS binpick_flags binpick_core binpick_perception EXPORT binpickTargets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT library)
install(DIRECTORY core perception DESTINATION include/binpick COMPONENT library FILES_MATCHING PATTERN "*.hpp")
install(EXPORT binpickTargets NAMESPACE binpick:: DESTINATION "${package_dir}" COMPONENT library)
configure_package_config_file(cmake/binpickConfig.cmake.in "${PROJECT_BINARY_DIR}/binpickConfig.cmake"
  INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/binpickConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/binpickConfig.cmake" "${PROJECT_BINARY_DIR}/binpickConfigVersion.cmake"
              cmake/binpick_dependencies.cmake
  DESTINATION "${package_dir}" COMPONENT library)
