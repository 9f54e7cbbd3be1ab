# What `cmake --install` puts under a prefix: the libraries with their public headers, the files by which
# CMake (find_package(gaitpad CONFIG)) and pkg-config find them, the program with its configuration, udev rules,
# manual pages, completions and what desktops show of it. `cpack -G DEB` makes two packages of the same
# (tools/package/debian.cmake): component `development` is libgaitpad-dev, `program` is gaitpad.
# Each library is a component of find_package, so that gaitpad::core needs GLM alone.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME development)
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

install(FILES ${CMAKE_CURRENT_LIST_DIR}/gaitpad-tests.cmake DESTINATION ${package_folder})

if(TARGET gaitpad)
  set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
  set(app io.github.gaitpad.gaitpad)
  set(made ${PROJECT_BINARY_DIR}/package)
  install(TARGETS gaitpad RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  if(TARGET gaitpad_window)
    install(TARGETS gaitpad_window LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/gaitpad)
  endif()
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/gaitpad)
  # udev reads those of /usr/lib and /usr/local/lib.
  install(FILES ${PROJECT_SOURCE_DIR}/config/udev/60-gaitpad.rules DESTINATION lib/udev/rules.d)

  # The program writes its manual pages when it is installed.
  find_program(GZIP_PROGRAM gzip REQUIRED)
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1\")
    message(STATUS \"Installing: \${folder}/gaitpad*.1.gz\")
    execute_process(COMMAND \"$<TARGET_FILE:gaitpad>\" __manual \"\${folder}\" COMMAND_ERROR_IS_FATAL ANY)
    file(GLOB pages \"\${folder}/gaitpad*.1\")
    execute_process(COMMAND \"${GZIP_PROGRAM}\" -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)
    list(TRANSFORM pages APPEND .gz)
    list(APPEND CMAKE_INSTALL_MANIFEST_FILES \${pages})" COMPONENT program)

  set(completions ${CMAKE_CURRENT_LIST_DIR}/completions)
  install(FILES ${completions}/gaitpad.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
          RENAME gaitpad)
  install(FILES ${completions}/gaitpad.zsh RENAME _gaitpad  # Debian's zsh looks into another folder than zsh itself
          DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/$<IF:$<STREQUAL:${CMAKE_INSTALL_PREFIX},/usr>,vendor-completions,site-functions>)
  install(FILES ${completions}/gaitpad.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

  install(FILES ${CMAKE_CURRENT_LIST_DIR}/${app}.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/${app}.svg
          DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
  string(TIMESTAMP PACKAGE_DAY %Y-%m-%d UTC)  # of SOURCE_DATE_EPOCH, where that is set
  configure_file(${CMAKE_CURRENT_LIST_DIR}/${app}.metainfo.xml.in ${made}/${app}.metainfo.xml @ONLY)
  install(FILES ${made}/${app}.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo)
  include(${CMAKE_CURRENT_LIST_DIR}/debian.cmake)
endif()
