# Installs headers, libraries, programs, and the package that find_package(crashrank) and pkg-config
# read. Parts to install by themselves: library (what a running program needs), dev, tools.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/crashrank)

install(DIRECTORY include/crashrank DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)

# An export set for each component: who wants the headers alone needs nothing else installed.
set(components core crashrank study)
if(CRASHRANK_BUILD_TOOLS)
  list(APPEND components import tools)
endif()
set(targets_of_core crashrank_core)
set(targets_of_crashrank crashrank)
set(targets_of_study crashrank_study)
set(targets_of_import crashrank_import)
set(targets_of_tools crashrank_cli)

# What a static library uses inside is left for its user to link, and so to find: CMake's name of
# the package and pkg-config's.
set(package_of_fmt::fmt "fmt 9")
set(package_of_hwy::hwy "hwy")
set(package_of_PNG::PNG "PNG")
set(package_of_Eigen3::Eigen "Eigen3 3.4")
set(package_of_Threads::Threads "Threads")
set(pkgconfig_of_fmt::fmt "fmt")
set(pkgconfig_of_hwy::hwy "libhwy")
set(pkgconfig_of_PNG::PNG "libpng")
set(pkgconfig_of_Eigen3::Eigen "eigen3")
set(pkgconfig_of_Threads::Threads "")

foreach(component ${components})
  set(part dev)  # the package's file for the programs comes and goes with them
  if(component STREQUAL "tools")
    set(part tools)
  endif()
  install(TARGETS ${targets_of_${component}} EXPORT crashrank-${component}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT dev)
  install(EXPORT crashrank-${component} NAMESPACE crashrank:: DESTINATION ${package_dir}
    COMPONENT ${part})

  set(dependencies_${component} "")
  set(pkgconfig_${component} "")
  get_target_property(links ${targets_of_${component}} INTERFACE_LINK_LIBRARIES)
  foreach(link ${links})
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" link "${link}")
    if(link MATCHES "^::@" OR link MATCHES "^crashrank(_|::)" OR link MATCHES "BUILD_INTERFACE" OR
        link STREQUAL "links-NOTFOUND")
      continue()  # marks of CMake's own, our own targets, and headers needed to build alone
    endif()
    if(NOT DEFINED package_of_${link})
      message(FATAL_ERROR "cmake/CrashrankInstall.cmake does not know whose package ${link} is")
    endif()
    string(APPEND dependencies_${component} "  find_dependency(${package_of_${link}})\n")
    string(APPEND pkgconfig_${component} " ${pkgconfig_of_${link}}")
  endforeach()
endforeach()

configure_package_config_file(cmake/crashrank-config.cmake.in crashrank-config.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(crashrank-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/crashrank-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/crashrank-config-version.cmake DESTINATION ${package_dir}
  COMPONENT dev)

# pkg-config: one file a component, found relative to itself wherever the prefix is moved. What a
# shared library links is its own affair; a static one passes it on.
get_target_property(kind crashrank TYPE)
set(pkgconfig_public "")
set(pkgconfig_system "")
if(kind STREQUAL "STATIC_LIBRARY")
  set(pkgconfig_public "${pkgconfig_crashrank}")
  set(pkgconfig_system " -pthread -lstdc++ -lm")
endif()
file(RELATIVE_PATH prefix_from_pkgconfig ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
  ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" prefix_from_pkgconfig "${prefix_from_pkgconfig}")
set(pc_files crashrank-core crashrank crashrank-study)
if(CRASHRANK_BUILD_TOOLS)
  list(APPEND pc_files crashrank-import)
endif()
foreach(name ${pc_files})
  configure_file(cmake/package/${name}.pc.in ${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endforeach()

# What ROS tools know the package by.
install(FILES package.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/crashrank COMPONENT dev)

if(CRASHRANK_BUILD_TOOLS)
  # Models, scenarios and the schemas of all documents, for the program and those who write for it.
  install(DIRECTORY data/models data/scenarios data/schemas
    DESTINATION ${CMAKE_INSTALL_DATADIR}/crashrank COMPONENT tools
    PATTERN testmodels EXCLUDE)
  install(FILES data/scenario.schema.json data/crashrank.root
    DESTINATION ${CMAKE_INSTALL_DATADIR}/crashrank COMPONENT tools)

  # The manual page is the program's own help.
  find_program(CRASHRANK_GZIP gzip)
  if(CRASHRANK_GZIP AND NOT CMAKE_CROSSCOMPILING)
    set(manual ${CMAKE_CURRENT_BINARY_DIR}/crashrank.1)
    add_custom_command(OUTPUT ${manual}.gz
      COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:crashrank_cli> -DVERSION=${PROJECT_VERSION}
        -DOUT=${manual} -P ${CMAKE_CURRENT_SOURCE_DIR}/cmake/package/manual.cmake
      COMMAND ${CRASHRANK_GZIP} -9nf ${manual}
      DEPENDS crashrank_cli cmake/package/manual.cmake VERBATIM)
    add_custom_target(manual ALL DEPENDS ${manual}.gz)
    install(FILES ${manual}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
  endif()

  # Completion scripts, made by the program from its own options.
  if(NOT CMAKE_CROSSCOMPILING)
    set(completion ${CMAKE_CURRENT_BINARY_DIR}/completion)
    add_custom_command(OUTPUT ${completion}/crashrank ${completion}/_crashrank
      COMMAND ${CMAKE_COMMAND} -E make_directory ${completion}
      COMMAND crashrank_cli completion bash > ${completion}/crashrank
      COMMAND crashrank_cli completion zsh > ${completion}/_crashrank
      DEPENDS crashrank_cli VERBATIM)
    add_custom_target(completion ALL DEPENDS ${completion}/crashrank ${completion}/_crashrank)
    install(FILES ${completion}/crashrank COMPONENT tools
      DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
    install(FILES ${completion}/_crashrank COMPONENT tools
      DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  endif()
endif()

if(PROJECT_IS_TOP_LEVEL)
  include(CrashrankPack)
endif()
