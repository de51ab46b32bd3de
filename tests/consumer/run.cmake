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
  # Arithmetic that may be reordered is refused rather than trusted.
  execute_process(COMMAND ${COMPILER} -std=c++17 -ffast-math -fsyntax-only
    -I${WORK}/prefix/include -x c++ ${WORK}/prefix/include/crashrank/base/version.hpp
    RESULT_VARIABLE status ERROR_VARIABLE trouble)
  if(status EQUAL 0 OR NOT trouble MATCHES "IEEE-754")
    message(FATAL_ERROR "-ffast-math was not refused: ${trouble}")
  endif()
endif()
message(STATUS "${first}")
