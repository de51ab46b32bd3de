# cmake -DFROM=... -DTO=... -DINPUT=... -DOUTPUT=... -P plant_fault.cmake
# Copies a header with one change. That FROM is not there exactly once is an error: a fault that is
# not planted would be "missed" by every check, or found for the wrong reason.
file(READ "${INPUT}" text)
string(FIND "${text}" "${FROM}" first)
string(FIND "${text}" "${FROM}" last REVERSE)
if(first EQUAL -1 OR NOT first EQUAL last)
  message(FATAL_ERROR
    "${INPUT}: \"${FROM}\" is not there exactly once; bring the planted fault up to date")
endif()
string(REPLACE "${FROM}" "${TO}" text "${text}")
file(WRITE "${OUTPUT}" "${text}")
