# Builds the project tests/consumer/${KIND} from nothing and runs its programs: all of them, built
# with whatever flags, have to print the same answer. "installed" is built against PREFIX, where
# BUILD is installed to first unless a prefix is given.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
if(KIND STREQUAL "installed")
  if(NOT PREFIX)
    set(PREFIX ${WORK}/prefix)
    run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX})
  endif()
  file(GLOB_RECURSE pc_file ${PREFIX}/*/crashrank.pc)
  get_filename_component(pc_dir "${pc_file}" DIRECTORY)
  get_filename_component(lib_dir "${pc_dir}" DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} ${pc_dir}:$ENV{PKG_CONFIG_PATH})
  set(ENV{LD_LIBRARY_PATH} ${lib_dir}:$ENV{LD_LIBRARY_PATH})
endif()
# A whole library is compiled to be run once.
if(KIND STREQUAL "subdirectory")
  set(optimisation "-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG")
endif()
run(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer/${KIND} -B ${WORK}/build -G Ninja
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=${UNITY} ${optimisation} -DCMAKE_CXX_COMPILER=${COMPILER}
  -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_CXX_FLAGS=${FLAGS}
  -DCMAKE_C_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_C_FLAGS=${FLAGS} -DCMAKE_PREFIX_PATH=${PREFIX} -DCRASHRANK_SOURCE=${SOURCE})
run(${CMAKE_COMMAND} --build ${WORK}/build -j 2)

file(GLOB programs ${WORK}/build/bin/consumer_*)
set(first "")
foreach(program ${programs})
  execute_process(COMMAND ${program} RESULT_VARIABLE status OUTPUT_VARIABLE answer
    ERROR_VARIABLE trouble)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${program} ended with ${status}: ${answer}${trouble}")
  endif()
  if(answer MATCHES "^not run")
    message(STATUS "${program}: ${answer}")
  elseif(first STREQUAL "")
    set(first "${answer}")
  elseif(NOT answer STREQUAL first)
    message(FATAL_ERROR "${program} answers\n${answer}but another program\n${first}")
  endif()
endforeach()
if(first STREQUAL "")
  message(FATAL_ERROR "no program answered")
endif()

# Without CMake: what pkg-config says is enough to compile and link, wherever the prefix is.
if(KIND STREQUAL "installed")
  separate_arguments(flags UNIX_COMMAND "${FLAGS}")
  function(pkg_config out)
    execute_process(COMMAND pkg-config ${ARGN} OUTPUT_VARIABLE said ERROR_VARIABLE trouble
      RESULT_VARIABLE status)
    if(NOT status EQUAL 0)
      message(FATAL_ERROR "pkg-config ${ARGN}: ${trouble}")
    endif()
    separate_arguments(said UNIX_COMMAND "${said}")
    set(${out} ${said} PARENT_SCOPE)
  endfunction()
  set(consumer ${SOURCE}/tests/consumer/installed)
  pkg_config(library --cflags --libs crashrank)
  run(cc -std=c11 ${flags} ${consumer}/ranking.c ${library} -o ${WORK}/build/bin/ranking_pkgconfig_c)
  pkg_config(import --cflags --libs crashrank-import)
  run(${COMPILER} -std=c++17 ${flags} ${SOURCE}/apps/examples/first_choice.cpp ${import}
    -o ${WORK}/build/bin/example_first_choice_pkgconfig)
endif()

# The rankings' closed form stands in ranking.cpp.
file(GLOB programs ${WORK}/build/bin/ranking_*)
if(NOT programs)
  message(FATAL_ERROR "no program ranks")
endif()
file(STRINGS /proc/cpuinfo avx2 REGEX "avx2" LIMIT_COUNT 1)
foreach(program ${programs})
  if(program MATCHES "avx2" AND NOT avx2)
    message(STATUS "${program}: not run, this processor lacks what the flags ask for")
    continue()
  endif()
  execute_process(COMMAND ${program} RESULT_VARIABLE status OUTPUT_VARIABLE answer
    ERROR_VARIABLE trouble)
  if(NOT status EQUAL 0 OR NOT answer STREQUAL "brake 8: 0.0 kJ\nbrake 5: 22.5 kJ\nbrake 0: 75.0 kJ\n")
    message(FATAL_ERROR "${program} ended with ${status}: ${answer}${trouble}")
  endif()
endforeach()

if(KIND STREQUAL "installed")
  # The example answers what the installed program ranks first.
  set(scenario ${SOURCE}/data/scenarios/oncoming_truck.json)
  execute_process(COMMAND ${PREFIX}/bin/crashrank rank ${scenario} --json
    RESULT_VARIABLE status OUTPUT_VARIABLE ranking ERROR_VARIABLE trouble)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "the installed crashrank ended with ${status}: ${trouble}")
  endif()
  string(JSON first_choice GET "${ranking}" ranking 0 candidate)
  file(GLOB programs ${WORK}/build/bin/example_first_choice*)
  foreach(program ${programs})
    # The package tells C++ where the importer is; a C program of a moved package is told so.
    set(ENV{CRASHRANK_IMPORTER} "")
    if(program MATCHES "_c$")
      file(GLOB_RECURSE importer ${PREFIX}/*/crashrank-import)
      set(ENV{CRASHRANK_IMPORTER} ${importer})
    endif()
    execute_process(COMMAND ${program} ${scenario}
      RESULT_VARIABLE status OUTPUT_VARIABLE choice ERROR_VARIABLE trouble)
    if(NOT status EQUAL 0)
      message(FATAL_ERROR "${program} ended with ${status}: ${trouble}")
    endif()
    if(NOT choice STREQUAL "${first_choice}\n")
      message(FATAL_ERROR "${program} chose ${choice} and crashrank ${first_choice}")
    endif()
  endforeach()
  # Arithmetic that may be reordered is refused rather than trusted.
  execute_process(COMMAND ${COMPILER} -std=c++17 -ffast-math -fsyntax-only
    -I${PREFIX}/include -x c++ ${PREFIX}/include/crashrank/base/version.hpp
    RESULT_VARIABLE status ERROR_VARIABLE trouble)
  if(status EQUAL 0 OR NOT trouble MATCHES "IEEE-754")
    message(FATAL_ERROR "-ffast-math was not refused: ${trouble}")
  endif()
endif()
message(STATUS "${first}")
