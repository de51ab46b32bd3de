# Debian packages, one a part: `cpack -G DEB` in a build with shared libraries below /usr (the
# preset "package"; scripts/package does it all and has lintian look at them).
set(CRASHRANK_CONTACT "The crashrank authors <maintainers@crashrank.example>" CACHE STRING
  "Name and address that packages give as their maintainer's")
set(soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME crashrank)
set(CPACK_PACKAGE_VENDOR "The crashrank authors")
set(CPACK_PACKAGE_CONTACT "${CRASHRANK_CONTACT}")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
# Each part says in its first line what it is; a line for all of them would come before that.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL library dev tools)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ
  GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS
  ${PROJECT_BINARY_DIR}/src ${PROJECT_BINARY_DIR}/src/mesh ${PROJECT_BINARY_DIR}/src/dispatch/study)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_COMPONENT_DEV_DEPENDS library)
set(CPACK_COMPONENT_TOOLS_DEPENDS library)

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libcrashrank${soversion})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_BINARY_DIR}/package/triggers)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS crashrank-tools)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION
"ranks the crashes a vehicle can still choose
Finds what touches what, when and how hard along candidate manoeuvres, and
ranks them by what they destroy. This package has the shared libraries.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libcrashrank-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS crashrank-tools)
set(CPACK_COMPONENT_DEV_DESCRIPTION
"ranks the crashes a vehicle can still choose (development files)
Headers for C++17 and later and for C, with the files that CMake and
pkg-config find them by.")

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME crashrank-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_COMPONENT_TOOLS_DESCRIPTION
"ranks the crashes a vehicle can still choose (programs)
The command crashrank, the importer of mesh files, the shipped models and
scenarios, and the JSON Schemas of all documents.")

# Every package says whose it is and what changed.
if(CRASHRANK_GZIP)
  configure_file(cmake/package/changelog.in package/changelog.Debian @ONLY)
  configure_file(cmake/package/copyright package/copyright COPYONLY)
  configure_file(CHANGELOG.md package/changelog COPYONLY)
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/package/triggers "activate-noawait ldconfig\n")
  execute_process(COMMAND ${CRASHRANK_GZIP} -9nf changelog.Debian changelog
    WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/package COMMAND_ERROR_IS_FATAL ANY)
  foreach(part LIBRARY DEV TOOLS)
    string(TOLOWER ${part} component)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/package/copyright
      ${CMAKE_CURRENT_BINARY_DIR}/package/changelog.gz
      ${CMAKE_CURRENT_BINARY_DIR}/package/changelog.Debian.gz
      DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${part}_PACKAGE_NAME}
      COMPONENT ${component} EXCLUDE_FROM_ALL)
    # These packages close no bug of Debian's. And CPack calls ldconfig in scripts of its own, as if
    # there were no trigger.
    set(name ${CPACK_DEBIAN_${part}_PACKAGE_NAME})
    set(overrides "${name}: initial-upload-closes-no-bugs\n")
    if(part STREQUAL LIBRARY)
      string(APPEND overrides "${name}: maintscript-calls-ldconfig\n")
    endif()
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/package/overrides/${name} "${overrides}")
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/package/overrides/${name}
      DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
      COMPONENT ${component} EXCLUDE_FROM_ALL)
  endforeach()
endif()
include(CPack)
