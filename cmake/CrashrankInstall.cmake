include(CMakePackageConfigHelpers)
install(DIRECTORY include/crashrank DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
