# Builds the project tests/consumer/${KIND} from nothing and runs its programs: all of them, built
# with whatever flags, have to print the same answer. "installed" is built against PREFIX; unless one
# is given, BUILD is installed and the prefix then moved.
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
    run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/installed)
    set(PREFIX ${WORK}/moved/prefix)
    file(MAKE_DIRECTORY ${WORK}/moved)
    file(RENAME ${WORK}/installed ${PREFIX})
  endif()
  file(GLOB_RECURSE pc_file ${PREFIX}/*/crashrank.pc)
  get_filename_component(pc_dir "${pc_file}" DIRECTORY)
  get_filename_component(lib_dir "${pc_dir}" DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} ${pc_dir}:$ENV{PKG_CONFIG_PATH})
  set(ENV{LD_LIBRARY_PATH} ${lib_dir}:$ENV{LD_LIBRARY_PATH})
endif()
# What is compiled is run once; what has to be optimised says so.
set(optimisation "-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG")
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

# Without CMake: what pkg-config says is enough to compile and link, wherever the prefix is, and
# unquoted: a shell splits it at spaces alone, make hands it to a shell.
if(KIND STREQUAL "installed")
  set(ranking ${SOURCE}/tests/consumer/installed/ranking.c)
  set(example ${SOURCE}/apps/examples/first_choice)
  set(bin ${WORK}/build/bin)
  function(compile package compiler source program)
    run(sh -c "${compiler} ${FLAGS} $(pkg-config --cflags ${package}) '${source}' \
      $(pkg-config --libs ${package}) -o '${program}'")
  endfunction()
  compile(crashrank "cc -std=c11" ${ranking} ${bin}/ranking_pkgconfig_c)
  compile(crashrank-import "cc -std=c11" ${example}.c ${bin}/example_first_choice_pkgconfig_c)
  compile(crashrank-import "${COMPILER} -std=c++17" ${example}.cpp
    ${bin}/example_first_choice_pkgconfig)
  file(WRITE ${WORK}/Makefile "\
CFLAGS = -std=c11 ${FLAGS} $(shell pkg-config --cflags crashrank-import)
CXXFLAGS = -std=c++17 ${FLAGS} $(shell pkg-config --cflags crashrank-import)
LDLIBS = $(shell pkg-config --libs crashrank-import)
all: ${bin}/ranking_make_c ${bin}/example_first_choice_make_c ${bin}/example_first_choice_make
${bin}/ranking_make_c: ${ranking}
\t$(CC) $(CFLAGS) $< $(LDLIBS) -o $@
${bin}/example_first_choice_make_c: ${example}.c
\t$(CC) $(CFLAGS) $< $(LDLIBS) -o $@
${bin}/example_first_choice_make: ${example}.cpp
\t$(CXX) $(CXXFLAGS) $< $(LDLIBS) -o $@
")
  run(make -f ${WORK}/Makefile CC=cc CXX=${COMPILER})
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
  # Every program finds the importer of the moved prefix by itself.
  unset(ENV{CRASHRANK_IMPORTER})
  foreach(program ${programs})
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
