# What `cmake --install` and CPack put beside the programs: cases, cards, libraries, workflow, man pages, completion, and
# the packages by which other projects find the contact law's headers. Programs find these files from where they lie
# (postproc/core/data_folder.h), so that a prefix may be moved.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(data ${CMAKE_INSTALL_DATADIR}/vielto)
foreach(folder cases materials libraries studies tools)
  install(DIRECTORY ${folder} DESTINATION ${data} USE_SOURCE_PERMISSIONS
    PATTERN results EXCLUDE PATTERN __pycache__ EXCLUDE PATTERN log.liggghts EXCLUDE PATTERN *.partial EXCLUDE)
endforeach()
# Libraries know by these files whether their runs were made with the law as it is.
install(DIRECTORY liggghts_addons/law DESTINATION ${data}/liggghts_addons)
install(DIRECTORY liggghts_addons/plugin/laws DESTINATION ${data}/liggghts_addons/plugin)
foreach(script calibrate campaign library study table)
  install(PROGRAMS scripts/${script} DESTINATION ${data}/scripts)
endforeach()
install(FILES README.md CITATION.cff AUTHORS cmake/install/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
find_program(GZIP_PROGRAM gzip REQUIRED)
execute_process(COMMAND ${GZIP_PROGRAM} -9nc CHANGELOG.md WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMAND_ERROR_IS_FATAL ANY
  OUTPUT_FILE ${CMAKE_BINARY_DIR}/changelog.gz)
install(FILES ${CMAKE_BINARY_DIR}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})

# `liggghts` is the name of another package's file; ours lies aside under that name and has one of its own in bin.
install(CODE "
  file(RELATIVE_PATH target \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\" \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/vielto/bin/liggghts\")
  file(CREATE_LINK \"\${target}\" \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}/liggghts-vielto\" SYMBOLIC)")

# find_package(vielto) and pkg-config: headers only, for LIGGGHTS source trees and for tests of the law.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/vielto-config-version.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
configure_package_config_file(cmake/install/vielto-config.cmake.in ${CMAKE_BINARY_DIR}/vielto-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_DATADIR}/cmake/vielto PATH_VARS CMAKE_INSTALL_INCLUDEDIR)
install(FILES ${CMAKE_BINARY_DIR}/vielto-config.cmake ${CMAKE_BINARY_DIR}/vielto-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_DATADIR}/cmake/vielto)
configure_file(cmake/install/vielto.pc.in ${CMAKE_BINARY_DIR}/vielto.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/vielto.pc DESTINATION ${CMAKE_INSTALL_DATADIR}/pkgconfig)

# Manual pages and completion say what --help says.
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/man/vielto.1 ${CMAKE_BINARY_DIR}/vielto.bash
  COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/cmake/install/manual.py $<TARGET_FILE:vielto> ${CMAKE_BINARY_DIR}/man
    ${CMAKE_BINARY_DIR}/vielto.bash ${PROJECT_VERSION}
  DEPENDS vielto cmake/install/manual.py VERBATIM)
add_custom_target(vielto_manual ALL DEPENDS ${CMAKE_BINARY_DIR}/man/vielto.1 ${CMAKE_BINARY_DIR}/vielto.bash)
install(DIRECTORY ${CMAKE_BINARY_DIR}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 FILES_MATCHING PATTERN *.1.gz)
install(FILES ${CMAKE_BINARY_DIR}/vielto.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME vielto)

# Debian package: `cpack -G DEB` in the build folder.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vielto)
set(CPACK_PACKAGE_CONTACT "ViElTo maintainers <maintainers@users.noreply.github.com>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "mixing power of granular mixers by DEM, and why it differs from measurement")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Contact laws for LIGGGHTS (ViElTo and others), input scripts of a paddle
mixer, a shear box, a heap and a drum, post-processing to mixing power and
dimensionless numbers, and a diagnosis of the gap between simulation and
measurement.")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_PACKAGE_DEPENDS "liggghts, python3")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "nodejs, snakemake, xvfb")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
include(CPack)
