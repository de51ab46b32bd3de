# Installs headers, libraries, programs, and the package that find_package(crashrank) reads. Its
# components are the targets: core, crashrank, import.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/crashrank)

install(DIRECTORY include/crashrank DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

# An export set for each component: who wants the headers alone needs nothing else installed.
set(components core crashrank)
if(TARGET crashrank_import)
  list(APPEND components import)
endif()
set(target_of_core crashrank_core)
set(target_of_crashrank crashrank)
set(target_of_import crashrank_import)

# What a static library uses inside is left for its user to link, and so to find.
set(package_of_fmt::fmt "fmt 9")
set(package_of_nlohmann_json::nlohmann_json "nlohmann_json 3.11")
set(package_of_hwy::hwy "hwy")
set(package_of_PNG::PNG "PNG")
set(package_of_Eigen3::Eigen "Eigen3 3.4")
set(package_of_Threads::Threads "Threads")

foreach(component ${components})
  set(target ${target_of_${component}})
  install(TARGETS ${target} EXPORT crashrank-${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT crashrank-${component} NAMESPACE crashrank:: DESTINATION ${package_dir})

  set(dependencies_${component} "")
  get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
  foreach(link ${links})
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" link "${link}")
    if(link MATCHES "^::@" OR link MATCHES "^crashrank(_|::)" OR link MATCHES "BUILD_INTERFACE")
      continue()  # marks of CMake's own, our own targets, and headers needed to build alone
    endif()
    if(NOT DEFINED package_of_${link})
      message(FATAL_ERROR "cmake/CrashrankInstall.cmake does not know whose package ${link} is")
    endif()
    string(APPEND dependencies_${component} "  find_dependency(${package_of_${link}})\n")
  endforeach()
endforeach()

set(importer_file ${CMAKE_INSTALL_LIBEXECDIR}/crashrank/crashrank-import)
configure_package_config_file(cmake/crashrank-config.cmake.in crashrank-config.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS importer_file)
write_basic_package_version_file(crashrank-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/crashrank-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/crashrank-config-version.cmake DESTINATION ${package_dir})
