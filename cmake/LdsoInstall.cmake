# What others see: find_package(ldso) gives ldso::ldso (the engine), find_package(ldso COMPONENTS io viewer output)
# also ldso::io, ldso::viewer and ldso::output (the folder that a run leaves). Each part is installed by itself, too:
# cmake --install BUILD --component engine|io|output|program|python|c.
# The rooms are exported as the static libraries that these targets are made of; their headers are private.

add_library(ldso_library INTERFACE)
add_library(ldso::ldso ALIAS ldso_library)
target_link_libraries(ldso_library INTERFACE ldso_sequence)
set_target_properties(ldso_library PROPERTIES EXPORT_NAME ldso)
if(NOT LDSO_INSTALL)
  return()
endif()

include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(ldso_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/ldso)

# ldso_install_targets(<component> <export> targets...)
function(ldso_install_targets component export)
  install(TARGETS ${ARGN} EXPORT ${export}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component})
  install(EXPORT ${export} NAMESPACE ldso:: DESTINATION ${ldso_package_dir} COMPONENT ${component})
endfunction()

get_property(engine_rooms GLOBAL PROPERTY LDSO_ROOMS_OF_engine)
ldso_install_targets(engine ldsoTargets ldso_library ${engine_rooms})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ldso DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT engine
  PATTERN "io" EXCLUDE PATTERN "viewer.h" EXCLUDE PATTERN "results_folder.h" EXCLUDE)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/ldsoConfig.cmake.in ${PROJECT_BINARY_DIR}/ldsoConfig.cmake
  INSTALL_DESTINATION ${ldso_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ldsoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ldsoConfig.cmake ${PROJECT_BINARY_DIR}/ldsoConfigVersion.cmake
  DESTINATION ${ldso_package_dir} COMPONENT engine)

if(TARGET ldso_io)
  ldso_install_targets(io ldsoIoTargets ldso_io)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ldso/io DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ldso COMPONENT io)
endif()
if(TARGET ldso_output)
  ldso_install_targets(output ldsoViewerTargets ldso_viewer)
  ldso_install_targets(output ldsoOutputTargets ldso_output ldso_imagery ldso_report ldso_results ldso_scaling ldso_running
    ldso_camera ldso_evaluation ldso_experiment)
  install(FILES ${PROJECT_SOURCE_DIR}/include/ldso/viewer.h ${PROJECT_SOURCE_DIR}/include/ldso/results_folder.h
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ldso COMPONENT output)
endif()
if(TARGET ldso_app)
  install(TARGETS ldso_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
