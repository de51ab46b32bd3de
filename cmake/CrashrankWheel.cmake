# What a wheel holds beside the package's Python code, all in one folder: the extension module with
# its stub, the program, the importer, the shared libraries that they need and that not every Linux
# has, and the licence texts of all that is linked or copied.
find_program(CRASHRANK_PATCHELF patchelf REQUIRED)
set(package crashrank)  # folder in the wheel

install(TARGETS crashrank_python LIBRARY DESTINATION ${package} COMPONENT python)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/crashrank/_core.pyi DESTINATION ${package}
  COMPONENT python)
install(FILES ${PROJECT_SOURCE_DIR}/data/benchmark/scenes.jsonl
  ${PROJECT_SOURCE_DIR}/data/benchmark/answers.csv ${PROJECT_SOURCE_DIR}/data/benchmark/benchmark.json
  DESTINATION ${package}/benchmark COMPONENT python)
install(TARGETS crashrank_cli crashrank-import RUNTIME DESTINATION ${package} COMPONENT python)

# Headers that are compiled in, by the name of their licence text.
find_path(cli_headers CLI/CLI.hpp REQUIRED)
find_path(json_headers nlohmann/json.hpp REQUIRED)
find_path(eigen_headers Eigen/Core PATH_SUFFIXES eigen3 REQUIRED)
find_path(tinygltf_headers tiny_gltf.h REQUIRED)
set(compiled_in "CLI11=${cli_headers}/CLI/CLI.hpp" "nlohmann-json=${json_headers}/nlohmann/json.hpp"
  "eigen=${eigen_headers}/Eigen/Core" "tinygltf=${tinygltf_headers}/tiny_gltf.h")
file(GLOB nanobind_licence ${NB_DIR}/../nanobind-*.dist-info/licenses/LICENSE)
if(NOT nanobind_licence)
  message(FATAL_ERROR "nanobind's licence text is not beside ${NB_DIR}")
endif()
install(FILES ${nanobind_licence} DESTINATION ${package}/licences RENAME nanobind.txt
  COMPONENT python)
# robin_map, inside nanobind, has its licence at the head of its headers alone.
file(READ ${NB_DIR}/ext/robin_map/include/tsl/robin_map.h robin_map_text)
string(REGEX MATCH "^/[*][*].*" robin_map_text "${robin_map_text}")
string(FIND "${robin_map_text}" "*/" robin_map_end)
string(SUBSTRING "${robin_map_text}" 0 ${robin_map_end} robin_map_text)
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/robin_map.txt CONTENT "${robin_map_text}")
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/robin_map.txt DESTINATION ${package}/licences
  COMPONENT python)

install(CODE "
  set(executables \"$<TARGET_FILE:crashrank-import>\" \"$<TARGET_FILE:crashrank_cli>\")
  set(module \"$<TARGET_FILE:crashrank_python>\")
  set(package \"${package}\")
  set(patchelf \"${CRASHRANK_PATCHELF}\")
  set(compiled_in \"${compiled_in}\")
  include(\"${PROJECT_SOURCE_DIR}/cmake/BundleLibraries.cmake\")
" COMPONENT python)
