// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Where this build finds what tests need. Compiled in, in one place.

#ifndef TEST_TESTING_PATHS_H_
#define TEST_TESTING_PATHS_H_

// Real maps and logs; need not exist.
extern const char* const kTestSharedDataDirectory;
// The checkout's configuration_files/.
extern const char* const kTestConfigurationDirectory;
// The program; tests of other folders than tools/ do not build it.
extern const char* const kTestProgram;

#endif  // TEST_TESTING_PATHS_H_
