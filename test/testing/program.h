// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef TEST_TESTING_PROGRAM_H_
#define TEST_TESTING_PROGRAM_H_

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "glog/logging.h"
#include "test/testing/paths.h"
#include "test/testing/temporary_directory.h"

struct ProgramResult {
  // -1 where it ended by a signal.
  int exit_code = -1;
  std::string output;
  std::string error;
};

// Runs a program as a process of its own, with files for its output.
inline ProgramResult RunProgramFile(const std::string& program,
                                    const std::vector<std::string>& arguments) {
  const cartographer_sdf::testing::TemporaryDirectory directory;
  const std::string output = directory.File("output");
  const std::string error = directory.File("error");
  std::vector<std::string> words = {program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  CHECK_GE(child, 0);
  if (child == 0) {
    dup2(open(output.c_str(), O_CREAT | O_WRONLY, 0600), STDOUT_FILENO);
    dup2(open(error.c_str(), O_CREAT | O_WRONLY, 0600), STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  CHECK_EQ(waitpid(child, &status, 0), child);
  ProgramResult result;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  result.output = directory.Read("output");
  result.error = directory.Read("error");
  return result;
}

inline ProgramResult RunTestProgram(const std::vector<std::string>& arguments) {
  return RunProgramFile(kTestProgram, arguments);
}

#endif  // TEST_TESTING_PROGRAM_H_
