# Flags of our own targets; nothing here reaches those who link the library.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
endif()

# The CLI's answers and the tests' seeds must not depend on the processor that built them: no
# -march flags here.
function(crashrank_compile target)
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor
    -Wold-style-cast -Woverloaded-virtual
    -ffp-contract=off $<$<BOOL:${CRASHRANK_WERROR}>:-Werror>)
  if(CMAKE_UNITY_BUILD)
    # Reading the headers takes most of a compiler's time: fewer joined sources are read more often.
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 16)
    # GCC 12 takes a header's names for a source's own, and sees less of what is set where. A local
    # name that hides a neighbour's constant hides nothing where each source is compiled alone.
    target_compile_options(${target} PRIVATE -Wno-shadow
      $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage -Wno-maybe-uninitialized>)
  endif()
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON POSITION_INDEPENDENT_CODE ON)
endfunction()

# What a shared library offers, said to the linker: hidden visibility does not reach what the
# standard library marks as visible.
function(crashrank_exports target)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "SHARED_LIBRARY" AND UNIX AND NOT APPLE)
    set(map ${PROJECT_SOURCE_DIR}/src/crashrank.map)
    target_link_options(${target} PRIVATE LINKER:--version-script=${map})
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${map})
  endif()
endfunction()
