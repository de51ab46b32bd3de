# Run while a wheel is installed: copies shared libraries into its folder lib and licence texts into
# its folder licences. Given: executables, module, package, patchelf, compiled_in (see
# CrashrankWheel.cmake).
set(folder "${CMAKE_INSTALL_PREFIX}/${package}")

# Libraries that the manylinux standard (PEP 600) expects on every machine.
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${executables} MODULES ${module}
  RESOLVED_DEPENDENCIES_VAR libraries UNRESOLVED_DEPENDENCIES_VAR missing
  PRE_EXCLUDE_REGEXES "^(ld-linux.*|linux-vdso|lib(c|m|pthread|dl|rt|stdc[+][+]|gcc_s|z))[.]so.*")
if(missing)
  message(FATAL_ERROR "libraries that the wheel needs are not found: ${missing}")
endif()

# The licence text of a system file: that of the Debian package that owns it, and the common texts
# that it refers to. `what` says what of it is in the wheel; a line for README.txt is added to the
# caller's `contents`.
function(install_licence file name what)
  file(REAL_PATH "${file}" real)
  set(failed TRUE)
  foreach(path "${file}" "${real}")
    # Packages may name files of a merged /usr as they were before.
    string(REGEX REPLACE "^/usr/lib/" "/lib/" before "${path}")
    foreach(known "${path}" "${before}")
      if(failed)
        execute_process(COMMAND dpkg-query -S "${known}" OUTPUT_VARIABLE owner ERROR_QUIET
          RESULT_VARIABLE failed)
      endif()
    endforeach()
  endforeach()
  string(REGEX REPLACE "[:,].*" "" owner "${owner}")
  set(text "/usr/share/doc/${owner}/copyright")
  if(failed OR NOT EXISTS "${text}")
    message(WARNING "no licence text of ${name} (${file}) is found: the wheel lacks it")
    return()
  endif()
  execute_process(COMMAND dpkg-query -W -f "\${Version}" "${owner}" OUTPUT_VARIABLE version)
  set(contents "${contents}  ${name}.txt: ${what}, from the package ${owner} ${version}\n" PARENT_SCOPE)
  file(COPY_FILE "${text}" "${folder}/licences/${name}.txt")
  file(READ "${text}" content)
  string(REGEX MATCHALL "/usr/share/common-licenses/[A-Za-z0-9.-]*[A-Za-z0-9]" common "${content}")
  foreach(licence ${common})
    get_filename_component(plain "${licence}" NAME)
    file(COPY_FILE "${licence}" "${folder}/licences/common-${plain}.txt")
  endforeach()
endfunction()

file(MAKE_DIRECTORY "${folder}/lib" "${folder}/licences")
set(files "")
foreach(installed ${executables} ${module})
  get_filename_component(name "${installed}" NAME)
  list(APPEND files "${folder}/${name}")
endforeach()

# Names of their own, so that a process that has another version of one of them loaded does not take
# that in its place.
set(contents "")
set(renamed "")
foreach(library ${libraries})
  get_filename_component(name "${library}" NAME)
  string(REGEX REPLACE "[.]so" "-crashrank.so" own_name "${name}")
  string(REGEX REPLACE "[.]so.*" "" plain "${name}")
  file(REAL_PATH "${library}" real)
  file(COPY_FILE "${real}" "${folder}/lib/${own_name}")
  list(APPEND renamed --replace-needed "${name}" "${own_name}")
  list(APPEND files "${folder}/lib/${own_name}")
  install_licence("${library}" "${plain}" "lib/${own_name}")
endforeach()
foreach(file ${files})
  get_filename_component(name "${file}" NAME)
  set(rpath "$ORIGIN/lib")
  set(own "")
  if(file MATCHES "/lib/[^/]*$")
    set(rpath "$ORIGIN")
    set(own --set-soname "${name}")
  endif()
  execute_process(COMMAND "${patchelf}" ${renamed} ${own} --set-rpath "${rpath}" "${file}"
    COMMAND_ERROR_IS_FATAL ANY)
endforeach()

foreach(entry ${compiled_in})
  string(REGEX REPLACE "=.*" "" name "${entry}")
  string(REGEX REPLACE "^[^=]*=" "" file "${entry}")
  install_licence("${file}" "${name}" "compiled in")
endforeach()
file(WRITE "${folder}/licences/README.txt" "Licence texts of what this folder's programs and module are made of, beside crashrank's own.

${contents}  nanobind.txt, robin_map.txt: compiled into the module

The others are the copyright files of whole Debian source packages: parts of those that are not shipped here,
their tests and packaging among them, may have licences of their own. common-*.txt are the full texts that these files
refer to, whether or not a part under that licence is shipped.
")
