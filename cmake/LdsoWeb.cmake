# The front end of the viewer: npm fetches its libraries when the project is configured, esbuild bundles it when it is
# built. Sets LDSO_WEB_READY; where something is missing that is OFF, the build goes on, and says so.

option(LDSO_VIEWER "Build the viewer (ldso run --view, ldso view); needs Boost, Node and npm" ON)
set(LDSO_WEB_READY OFF)
set(LDSO_WEB_MODULES ${PROJECT_BINARY_DIR}/web/node_modules)
set(LDSO_WEB_DIST ${PROJECT_BINARY_DIR}/web/dist)

function(ldso_without_viewer reason)
  message(WARNING "ldso is built without its viewer: ${reason}. `ldso run --view` and `ldso view` will say so; "
    "everything else works. -DLDSO_VIEWER=OFF leaves it out without this warning.")
endfunction()

# ldso_install_web_modules(<ok>): npm ci in the build folder, if what it depends on has changed.
function(ldso_install_web_modules ok)
  set(sources ${PROJECT_SOURCE_DIR}/web/package.json ${PROJECT_SOURCE_DIR}/web/package-lock.json)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${sources})
  set(options --ignore-scripts --no-audit --no-fund --prefer-offline)
  if(NOT LDSO_BUILD_TESTS)
    list(APPEND options --omit=dev)
  endif()
  set(wanted "${options}")
  foreach(source IN LISTS sources)
    file(SHA256 ${source} hash)
    string(APPEND wanted " ${hash}")
  endforeach()
  set(stamp ${PROJECT_BINARY_DIR}/web/installed.txt)
  set(found "")
  if(EXISTS ${stamp})
    file(READ ${stamp} found)
  endif()
  set(${ok} ON PARENT_SCOPE)
  if(found STREQUAL wanted)
    return()
  endif()
  message(STATUS "Fetching the viewer's libraries (npm ci)")
  file(COPY ${sources} DESTINATION ${PROJECT_BINARY_DIR}/web)
  # Where the registry cannot be reached npm would try for minutes.
  set(patience --fetch-retries=2 --fetch-retry-mintimeout=1000 --fetch-retry-maxtimeout=5000)
  execute_process(COMMAND ${LDSO_NPM} ci ${options} ${patience} WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/web
    RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE errors TIMEOUT 300)
  if(result EQUAL 0)
    file(WRITE ${stamp} "${wanted}")
  else()
    message(STATUS "npm: ${errors}")
    set(${ok} OFF PARENT_SCOPE)
  endif()
endfunction()

if(NOT LDSO_VIEWER)
  return()
endif()
find_package(Boost 1.74 QUIET)
find_program(LDSO_NODE NAMES node nodejs)
find_program(LDSO_NPM npm)
if(NOT Boost_FOUND)
  ldso_without_viewer("Boost is missing (libboost-dev)")
  return()
elseif(NOT LDSO_NODE OR NOT LDSO_NPM)
  ldso_without_viewer("Node is missing (nodejs, npm)")
  return()
endif()
ldso_install_web_modules(LDSO_WEB_READY)
if(NOT LDSO_WEB_READY)
  ldso_without_viewer("npm could not fetch the libraries that web/package-lock.json names (see above)")
  return()
endif()

# Beside the libraries, for the check of the types.
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/web/src ${PROJECT_BINARY_DIR}/web/src SYMBOLIC)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/web/tsconfig.json ${PROJECT_BINARY_DIR}/web/tsconfig.json SYMBOLIC)
file(GLOB_RECURSE web_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/src/* ${PROJECT_SOURCE_DIR}/web/static/*)
set(LDSO_WEB_FILES ${LDSO_WEB_DIST}/app.js ${LDSO_WEB_DIST}/report.js ${LDSO_WEB_DIST}/index.html ${LDSO_WEB_DIST}/style.css
  ${LDSO_WEB_DIST}/icon.svg)
add_custom_command(OUTPUT ${LDSO_WEB_FILES}
  COMMAND ${LDSO_NODE} ${PROJECT_SOURCE_DIR}/web/build.mjs ${LDSO_WEB_MODULES} ${LDSO_WEB_DIST}
  DEPENDS ${web_sources} ${PROJECT_SOURCE_DIR}/web/build.mjs ${PROJECT_BINARY_DIR}/web/installed.txt
  COMMENT "Bundling the viewer's page" VERBATIM)
add_custom_target(ldso_web DEPENDS ${LDSO_WEB_FILES})
