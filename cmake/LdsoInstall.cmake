# The library as others see it: target ldso::ldso, installed for find_package(ldso) with its public headers and the
# program.

# The one target that others link. Its rooms are exported with it, as its static libraries; their headers are private.
add_library(ldso_library INTERFACE)
add_library(ldso::ldso ALIAS ldso_library)
target_link_libraries(ldso_library INTERFACE ldso_slam ldso_viewer)
set_target_properties(ldso_library PROPERTIES EXPORT_NAME ldso)
if(NOT LDSO_INSTALL)
  return()
endif()

include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

get_property(ldso_rooms GLOBAL PROPERTY LDSO_ROOMS)
install(TARGETS ldso_library ${ldso_rooms} EXPORT ldsoTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ldso DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(ldso_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/ldso)
install(EXPORT ldsoTargets NAMESPACE ldso:: DESTINATION ${ldso_package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/ldsoConfig.cmake.in ${PROJECT_BINARY_DIR}/ldsoConfig.cmake
  INSTALL_DESTINATION ${ldso_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ldsoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ldsoConfig.cmake ${PROJECT_BINARY_DIR}/ldsoConfigVersion.cmake
  DESTINATION ${ldso_package_dir})

if(TARGET ldso_app)
  install(TARGETS ldso_app RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
