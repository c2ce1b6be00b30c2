# SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
# SPDX-License-Identifier: Apache-2.0

# Sets COMMIT to the commit of the sources: of the repository, of the archive
# that git made of it (export-subst in .gitattributes), or "unknown".

set(CARTOGRAPHER_SDF_COMMIT "" CACHE STRING
    "Name of the commit, for a build from sources that do not know theirs")

function(find_commit result)
  if(CARTOGRAPHER_SDF_COMMIT)
    set(${result} "${CARTOGRAPHER_SDF_COMMIT}" PARENT_SCOPE)
    return()
  endif()
  find_program(GIT_PROGRAM git)
  mark_as_advanced(GIT_PROGRAM)
  # Not the commit of a repository that merely contains these sources.
  if(GIT_PROGRAM AND EXISTS "${PROJECT_SOURCE_DIR}/.git")
    execute_process(
      COMMAND "${GIT_PROGRAM}" -C "${PROJECT_SOURCE_DIR}" describe --always --dirty --tags --abbrev=12
      OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE code ERROR_QUIET)
    execute_process(
      COMMAND "${GIT_PROGRAM}" -C "${PROJECT_SOURCE_DIR}" rev-parse --git-path logs/HEAD
      OUTPUT_VARIABLE log OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    get_filename_component(log "${log}" ABSOLUTE BASE_DIR "${PROJECT_SOURCE_DIR}")
    if(EXISTS "${log}")
      # A commit configures again.
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${log}")
    endif()
    if(code EQUAL 0 AND described)
      set(${result} "${described}" PARENT_SCOPE)
      return()
    endif()
  endif()
  file(STRINGS "${PROJECT_SOURCE_DIR}/cmake/archived_commit.txt" archived LIMIT_COUNT 1)
  if(archived MATCHES "^[0-9a-f]+$")
    set(${result} "${archived}" PARENT_SCOPE)
  else()
    set(${result} "unknown" PARENT_SCOPE)
  endif()
endfunction()

find_commit(COMMIT)
message(STATUS "Commit: ${COMMIT}")
