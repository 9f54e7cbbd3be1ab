# What `cmake --install` puts under a prefix: the libraries with their public headers, the files by which
# CMake (find_package(gaitpad CONFIG)) and pkg-config find them, the program and its configuration.
# Each library is a component of its own, so that gaitpad::core needs GLM alone.
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/gaitpad)
set(components core)
if(TARGET gaitpad_session)
  list(APPEND components files devices session)
endif()
foreach(component ${components})
  install(TARGETS gaitpad_${component} EXPORT gaitpad-${component} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT gaitpad-${component} NAMESPACE gaitpad:: DESTINATION ${package_folder})
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/include/gaitpad DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")

# The pkg-config modules of the drivers that were built, and the names of their CMake targets.
get_property(driver_modules GLOBAL PROPERTY gaitpad_driver_modules)
set(DRIVER_MODULES ${driver_modules})
set(PKG_CONFIG_DRIVERS libudev)
foreach(entry ${driver_modules})
  string(REGEX REPLACE "^.*=" "" module ${entry})
  list(APPEND PKG_CONFIG_DRIVERS ${module})
endforeach()
list(JOIN PKG_CONFIG_DRIVERS " " PKG_CONFIG_DRIVERS)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/gaitpad-config.cmake.in
                              ${PROJECT_BINARY_DIR}/gaitpad-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gaitpad-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gaitpad-config.cmake ${PROJECT_BINARY_DIR}/gaitpad-config-version.cmake
        DESTINATION ${package_folder})
# From the folder of the pkg-config files up to the prefix: `cmake --install --prefix` may name another one than the
# configuration did.
file(RELATIVE_PATH PREFIX_ABOVE_PKGCONFIG ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
if(GAITPAD_TBB)
  set(TBB_LIBRARY "-ltbb ")
endif()
set(modules gaitpad-core)
if(TARGET gaitpad_session)
  list(APPEND modules gaitpad)
endif()
foreach(module ${modules})
  configure_file(${CMAKE_CURRENT_LIST_DIR}/${module}.pc.in ${PROJECT_BINARY_DIR}/${module}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${module}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()

if(TARGET gaitpad)
  install(TARGETS gaitpad RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/gaitpad)
endif()
