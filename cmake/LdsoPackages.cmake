# Packages: `cpack` in a build folder that was configured with -DCMAKE_INSTALL_PREFIX=/usr makes those of Debian.
# scripts/package.sh does all of it, makes a tarball of the program as well, and tries them out.
if(NOT LDSO_INSTALL OR NOT PROJECT_IS_TOP_LEVEL OR NOT TARGET ldso_app)
  return()
endif()
option(LDSO_PACKAGES "Prepare packages: manual pages and what else belongs to them; needs help2man and gzip" OFF)
if(NOT LDSO_PACKAGES)
  return()
endif()
find_program(LDSO_HELP2MAN help2man REQUIRED)
find_program(LDSO_GZIP gzip REQUIRED)
find_program(LDSO_BASH bash REQUIRED)
set(packaging ${PROJECT_SOURCE_DIR}/packaging)
set(made ${PROJECT_BINARY_DIR}/packaging)

add_custom_command(OUTPUT ${made}/man/ldso.1.gz
  COMMAND ${CMAKE_COMMAND} -E env "SOURCE_DATE_EPOCH=$ENV{SOURCE_DATE_EPOCH}" ${LDSO_BASH} ${packaging}/make_man_pages.sh $<TARGET_FILE:ldso_app> ${LDSO_HELP2MAN} ${made}/man
  DEPENDS ldso_app ${packaging}/make_man_pages.sh VERBATIM)
add_custom_target(ldso_man ALL DEPENDS ${made}/man/ldso.1.gz)
install(DIRECTORY ${made}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${packaging}/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ldso
  COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/data/vocabulary.ldsovoc DESTINATION ${CMAKE_INSTALL_DATADIR}/ldso
  COMPONENT program)

# Component, package: those of one package are one group.
set(packages "c=libldso1" "c_development=libldso-dev" "engine=libldso-dev" "io=libldso-dev" "output=libldso-dev"
  "program=ldso" "python=python3-ldso")
set(CPACK_COMPONENTS_ALL c c_development engine io output program python)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(${packaging}/copyright.in ${made}/copyright @ONLY)
configure_file(${packaging}/changelog.Debian.in ${made}/changelog.Debian @ONLY)
execute_process(COMMAND ${LDSO_GZIP} -9nkf ${made}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
foreach(pair IN LISTS packages)
  string(REPLACE "=" ";" pair ${pair})
  list(GET pair 0 component)
  list(GET pair 1 package)
  string(TOUPPER ${component} COMPONENT)
  set(CPACK_COMPONENT_${COMPONENT}_GROUP ${package})
  if(NOT package IN_LIST documented)
    list(APPEND documented ${package})
    install(FILES ${made}/copyright ${made}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
      COMPONENT ${component})
  endif()
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ldso)
set(CPACK_PACKAGE_VENDOR "The ldso authors")
set(CPACK_PACKAGE_CONTACT "The ldso authors <ldso@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
  WORLD_EXECUTE)

# CPack gives all packages the same first line; what is special about one comes below.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "monocular direct visual SLAM")
# ldso_describe_package(<package> <section> <what it has>)
macro(ldso_describe_package package section what)
  string(TOUPPER ${package} PACKAGE)
  set(CPACK_DEBIAN_${PACKAGE}_PACKAGE_NAME ${package})
  set(CPACK_DEBIAN_${PACKAGE}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${PACKAGE}_DESCRIPTION
    "Images of one camera in, the camera's trajectory and a sparse 3D map out.\n.\nThis package has ${what}.")
endmacro()
ldso_describe_package(libldso1 libs "the library of the interface in C")
ldso_describe_package(libldso-dev libdevel
  "the headers of the interfaces in C and C++, the static\nlibraries of that in C++, and what CMake and pkg-config find them by")
ldso_describe_package(ldso science "the program, with its viewer, simulator and evaluation")
ldso_describe_package(python3-ldso python "the module for Python 3")
set(CPACK_DEBIAN_LIBLDSO-DEV_PACKAGE_DEPENDS
  "libldso1 (= ${PROJECT_VERSION}-1), libceres-dev, libeigen3-dev, libhwy-dev, libopencv-dev, libyaml-cpp-dev, libzip-dev, nlohmann-json3-dev, pkgconf | pkg-config")
set(CPACK_DEBIAN_LDSO_PACKAGE_SUGGESTS "bash-completion, libldso-dev, python3-ldso")
set(CPACK_DEBIAN_PYTHON3-LDSO_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
set(CPACK_DEBIAN_LIBLDSO1_PACKAGE_CONTROL_EXTRA ${packaging}/libldso1/triggers ${packaging}/libldso1/shlibs)
set(CPACK_DEBIAN_PYTHON3-LDSO_PACKAGE_CONTROL_EXTRA ${packaging}/python3-ldso/postinst ${packaging}/python3-ldso/prerm)

include(CPack)
