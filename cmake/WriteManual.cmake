# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Has the programs write their pages of the manual, and scripts for completion.
# usage: cmake -DPROGRAMS="...;..." -DOUTPUT_DIR=DIR -P WriteManual.cmake

function(write_output path)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE text RESULT_VARIABLE code)
  if(NOT code EQUAL 0 OR text STREQUAL "")
    message(FATAL_ERROR "${ARGN} did not say what belongs into ${path}")
  endif()
  file(WRITE "${path}" "${text}")
endfunction()

file(REMOVE_RECURSE "${OUTPUT_DIR}")
foreach(program IN LISTS PROGRAMS)
  get_filename_component(name "${program}" NAME)
  write_output("${OUTPUT_DIR}/man1/${name}.1" "${program}" --man)
  if(NOT name STREQUAL "cartographer_sdf")
    continue()
  endif()
  execute_process(COMMAND "${program}" help OUTPUT_VARIABLE help)
  string(REGEX REPLACE "^.*\nSubcommands:\n" "" help "${help}")
  string(REGEX REPLACE "\n\n.*$" "\n" help "${help}")
  string(REGEX MATCHALL "\n  [a-z_]+ " subcommands "\n${help}")
  foreach(subcommand IN LISTS subcommands)
    string(STRIP "${subcommand}" subcommand)
    write_output("${OUTPUT_DIR}/man1/${name}-${subcommand}.1" "${program}" "${subcommand}" --man)
  endforeach()
  foreach(shell IN ITEMS bash zsh)
    write_output("${OUTPUT_DIR}/completion.${shell}" "${program}" completion ${shell})
  endforeach()
endforeach()
file(TOUCH "${OUTPUT_DIR}/written")
