# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Writes OUTPUT, a C++ source file that defines the contents of text files as
# constants: cmake -DOUTPUT=... -DTEXTS=NAME=PATH;... -P EmbedText.cmake

set(source "// Written by cmake/EmbedText.cmake.\n\nnamespace cartographer_sdf {\n")
foreach(text IN LISTS TEXTS)
  string(REGEX MATCH "^([^=]+)=(.*)$" matched "${text}")
  file(READ "${CMAKE_MATCH_2}" content)
  string(APPEND source
    "\nextern const char ${CMAKE_MATCH_1}[];\nconst char ${CMAKE_MATCH_1}[] = R\"~~~~(${content})~~~~\";\n")
endforeach()
string(APPEND source "\n}  // namespace cartographer_sdf\n")
file(WRITE "${OUTPUT}" "${source}")
