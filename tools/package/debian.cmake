# `cpack -G DEB` in a build folder that was configured with -DCMAKE_INSTALL_PREFIX=/usr: the packages gaitpad,
# libgaitpad-dev and libgaitpad0. tools/package_test.sh makes and tries them.
set(CPACK_PACKAGE_NAME gaitpad)
set(CPACK_PACKAGE_VENDOR "The gaitpad authors")
set(CPACK_PACKAGE_CONTACT "The gaitpad authors <gaitpad@users.noreply.github.com>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(packages gaitpad libgaitpad-dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"gamepad walks a motion-captured character
A gamepad's stick walks a character that is posed by weighted half-Jacobian
inverse kinematics on a captured stride: with legs of any length, on level
ground, slopes and stairs, even, stiff, tired or limping.

The program measures and calibrates sticks, replays recorded sessions bit
for bit, judges recordings in continuous integration, and exports walks as
BVH, glTF, CSV and JSON.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME gaitpad)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "ffmpeg, hid-tools")
if(GAITPAD_WINDOW)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS fonts-dejavu-core) # the window's, beside what SHLIBDEPS finds
endif()

set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"walking character and gamepads as a C++ library
Static libraries, headers, CMake package and pkg-config files of gaitpad: the
walking character with its inverse kinematics (which needs GLM alone), its
files, gamepads with calibration, live and replayed sessions.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libgaitpad-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "gaitpad, libsdl2-2.0-0")
# The packages of the headers that find_package(gaitpad) asks for.
set(debian_of_udev libudev-dev)
set(debian_of_osc liblo-dev)
set(debian_of_hidraw libhidapi-dev)
set(debian_of_usb libusb-1.0-0-dev)
set(debian_of_evdev libevdev-dev)
set(needs libglm-dev libfmt-dev libtomlplusplus-dev libpng-dev nlohmann-json3-dev libudev-dev pkg-config)
foreach(entry ${driver_modules})
  string(REGEX REPLACE "=.*$" "" driver ${entry})
  if(NOT debian_of_${driver})
    message(FATAL_ERROR "debian.cmake does not know the package with the headers of ${entry}")
  endif()
  list(APPEND needs ${debian_of_${driver}})
endforeach()
if(GAITPAD_TBB)
  list(APPEND needs libtbb-dev)
endif()
list(JOIN needs ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)


if(TARGET gaitpad_c)
  list(APPEND CPACK_COMPONENTS_ALL library)
  list(APPEND packages libgaitpad0)
  set(CPACK_COMPONENT_LIBRARY_DESCRIPTION
"walking character as a library in C
The walking character of gaitpad for programs in C and for languages that
call C: skeletons, grounds and sticks in, poses and steps out.")
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libgaitpad0)
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
  # As dpkg-shlibdeps finds them. CPack's SHLIBDEPS would add scripts that call ldconfig, where policy wants a trigger.
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libc6 (>= 2.34), libgcc-s1 (>= 3.0), libstdc++6 (>= 11)")
  file(WRITE ${made}/libgaitpad0/shlibs "libgaitpad 0 libgaitpad0 (>= ${PROJECT_VERSION})\n")
  file(WRITE ${made}/libgaitpad0/triggers "activate-noawait ldconfig\n")
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${made}/libgaitpad0/shlibs ${made}/libgaitpad0/triggers)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", libgaitpad0 (= ${PROJECT_VERSION}-1)")
endif()

# What Debian's policy wants beside each: licence and changelog.
string(TIMESTAMP PACKAGE_TIME "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(component_of_gaitpad program)
set(component_of_libgaitpad-dev development)
set(component_of_libgaitpad0 library)
foreach(package ${packages})
  set(component ${component_of_${package}})
  set(documents ${CMAKE_INSTALL_DATADIR}/doc/${package})
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${documents} COMPONENT ${component})
  file(WRITE ${made}/${package}/changelog.Debian "gaitpad (${PROJECT_VERSION}-1) unstable; urgency=medium

  * See changelog.gz for what changed.

 -- ${CPACK_PACKAGE_CONTACT}  ${PACKAGE_TIME}
")
  configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${made}/${package}/changelog COPYONLY)
  execute_process(COMMAND ${GZIP_PROGRAM} -9nf ${made}/${package}/changelog.Debian ${made}/${package}/changelog
                  COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${made}/${package}/changelog.Debian.gz ${made}/${package}/changelog.gz DESTINATION ${documents}
          COMPONENT ${component})
endforeach()
include(CPack)
