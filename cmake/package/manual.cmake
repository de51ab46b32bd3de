# Writes the manual page OUT of version VERSION from what PROGRAM says about itself.
function(help out)
  execute_process(COMMAND ${PROGRAM} ${ARGN} --help OUTPUT_VARIABLE text RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${PROGRAM} ${ARGN} --help ended with ${status}")
  endif()
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  string(REGEX REPLACE "(^|\n)([.'])" "\\1\\\\&\\2" text "${text}")
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

help(general)
execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE plain)
string(REGEX MATCH "Subcommands:\n(  [^\n]*\n)+" list "${plain}")
string(REGEX MATCHALL "\n  [a-z][a-z-]*" commands "${list}")
if(NOT commands)
  message(FATAL_ERROR "no subcommands found in the program's help")
endif()

set(page ".TH CRASHRANK 1 \"\" \"crashrank ${VERSION}\" \"User Commands\"
.SH NAME
crashrank \\- rank the crashes a vehicle can still choose, least harmful first
.SH SYNOPSIS
.B crashrank
.I COMMAND
.RI [ ARGUMENTS ]
.SH DESCRIPTION
When a crash cannot be avoided, crashrank looks at all the crashes that a vehicle can still choose
and ranks them, least destructive first.
.PP
.nf
${general}.fi
.SH COMMANDS
")
foreach(command ${commands})
  string(STRIP "${command}" command)
  help(text ${command})
  string(APPEND page ".SS ${command}\n.nf\n${text}.fi\n")
endforeach()
string(APPEND page ".SH FILES
.TP
.I /usr/share/crashrank/schemas
JSON Schemas of every answer given with
.BR \\-\\-json ,
and of the scenario format beside them.
.SH ENVIRONMENT
.TP
.B NO_COLOR
No colours, even on a terminal.
.TP
.B CRASHRANK_IMPORTER
The program that parses mesh files.
")
file(WRITE ${OUT} "${page}")
