# Builds the project tests/consumer/${KIND} from nothing and runs its programs: all of them, built
# with whatever flags, have to print the same answer.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
if(KIND STREQUAL "installed")
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
endif()
run(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer/${KIND} -B ${WORK}/build -G Ninja
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=${COMPILER}
  -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DCMAKE_CXX_FLAGS=${FLAGS}
  -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCRASHRANK_SOURCE=${SOURCE})
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

if(KIND STREQUAL "installed")
  # The example answers what the installed program ranks first, and the README shows its text.
  set(scenario ${SOURCE}/data/scenarios/oncoming_truck.json)
  execute_process(COMMAND ${WORK}/build/bin/example_first_choice ${scenario}
    RESULT_VARIABLE status OUTPUT_VARIABLE choice ERROR_VARIABLE trouble)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "example_first_choice ended with ${status}: ${trouble}")
  endif()
  execute_process(COMMAND ${WORK}/prefix/bin/crashrank rank ${scenario} --json
    RESULT_VARIABLE status OUTPUT_VARIABLE ranking ERROR_VARIABLE trouble)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "the installed crashrank ended with ${status}: ${trouble}")
  endif()
  string(JSON first_choice GET "${ranking}" ranking 0 candidate)
  if(NOT choice STREQUAL "${first_choice}\n")
    message(FATAL_ERROR "the example chose ${choice} and the program ${first_choice}")
  endif()
  file(READ ${SOURCE}/apps/examples/first_choice.cpp example)
  file(READ ${SOURCE}/README.md readme)
  string(FIND "${readme}" "${example}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "README.md does not show apps/examples/first_choice.cpp as it is")
  endif()

  # Arithmetic that may be reordered is refused rather than trusted.
  execute_process(COMMAND ${COMPILER} -std=c++17 -ffast-math -fsyntax-only
    -I${WORK}/prefix/include -x c++ ${WORK}/prefix/include/crashrank/base/version.hpp
    RESULT_VARIABLE status ERROR_VARIABLE trouble)
  if(status EQUAL 0 OR NOT trouble MATCHES "IEEE-754")
    message(FATAL_ERROR "-ffast-math was not refused: ${trouble}")
  endif()
endif()
message(STATUS "${first}")
