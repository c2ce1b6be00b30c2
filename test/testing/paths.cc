// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "test/testing/paths.h"

const char* const kTestSharedDataDirectory = TEST_SHARED_DATA_DIRECTORY;
const char* const kTestConfigurationDirectory = TEST_CONFIGURATION_DIRECTORY;
const char* const kTestProgram = TEST_PROGRAM;
