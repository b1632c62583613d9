# What `cmake --install build/release` writes, and the packages that `cpack --config build/release/CPackConfig.cmake`
# makes of it. Components: program (the program, its machines and scenes), development (headers and libraries).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/swarf")

# Scenes name their machines by relative paths, so that both stand as they do in the source tree.
install(TARGETS swarf RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT program)
# Its library is a dependency that the program itself does not have: a component of its own, in no package.
if(TARGET swarf_mpi)
  install(TARGETS swarf_mpi LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/swarf" COMPONENT cluster)
endif()
install(DIRECTORY assets/machines assets/posts assets/programs assets/schemas DESTINATION "${CMAKE_INSTALL_DATADIR}/swarf/assets" COMPONENT program
  PATTERN "*.py" EXCLUDE)
install(DIRECTORY scenes DESTINATION "${CMAKE_INSTALL_DATADIR}/swarf" COMPONENT program
  PATTERN "*.py" EXCLUDE PATTERN "generator" EXCLUDE)
install(PROGRAMS assets/cluster/batch_array.sh DESTINATION "${CMAKE_INSTALL_DATADIR}/swarf/assets/cluster" COMPONENT program)
install(FILES LICENSE README.md THIRD_PARTY.md CHANGELOG.md DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)

foreach(form man bash)
  add_custom_command(OUTPUT "${PROJECT_BINARY_DIR}/manual.${form}" DEPENDS swarf VERBATIM
    COMMAND swarf manual ${form} > "${PROJECT_BINARY_DIR}/manual.${form}")
endforeach()
add_custom_target(manual ALL DEPENDS "${PROJECT_BINARY_DIR}/manual.man" "${PROJECT_BINARY_DIR}/manual.bash")
install(FILES "${PROJECT_BINARY_DIR}/manual.man" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" RENAME swarf.1
  COMPONENT program)
install(FILES "${PROJECT_BINARY_DIR}/manual.bash"
  DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" RENAME swarf COMPONENT program)

foreach(module base mesh surface brep cutter position kinematics program toolpath flank motion machine post stock collision measure proof sim avoidance papers render
               reports)
  set_target_properties(swarf_${module} PROPERTIES EXPORT_NAME ${module})
  list(APPEND libraries swarf_${module})
endforeach()
set_target_properties(swarf_settings PROPERTIES EXPORT_NAME settings)
install(TARGETS ${libraries} swarf_settings EXPORT swarfTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  COMPONENT development)
install(EXPORT swarfTargets NAMESPACE swarf:: DESTINATION "${package_dir}" COMPONENT development)
install(DIRECTORY engine/ DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/swarf" COMPONENT development
  FILES_MATCHING PATTERN "*.h")
install(DIRECTORY render reports DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/swarf" COMPONENT development
  FILES_MATCHING PATTERN "*.h" PATTERN "out" EXCLUDE PATTERN "gallery" EXCLUDE PATTERN "perf" EXCLUDE)
configure_package_config_file(cmake/swarfConfig.cmake.in "${PROJECT_BINARY_DIR}/swarfConfig.cmake"
  INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/swarfConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/swarfConfig.cmake" "${PROJECT_BINARY_DIR}/swarfConfigVersion.cmake"
              cmake/dependencies.cmake
  DESTINATION "${package_dir}" COMPONENT development)

set(CPACK_PACKAGE_NAME swarf)
set(CPACK_PACKAGE_VENDOR "Swarf")
set(CPACK_PACKAGE_CONTACT "the Swarf project")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Headless, visual 5-axis NC simulator that measures and proves the part")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_GENERATOR "DEB;TGZ")
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What is opened while it runs is seen by no linker: the renderer of the movie and the letters of the pictures.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libosmesa6, fonts-dejavu-core")
include(CPack)
