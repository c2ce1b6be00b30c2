// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// The files of inspector/, which cmake/EmbedText.cmake compiles into the
// library. Not installed.

#ifndef CARTOGRAPHER_SDF_REPORT_INSPECTOR_TEMPLATE_H_
#define CARTOGRAPHER_SDF_REPORT_INSPECTOR_TEMPLATE_H_

namespace cartographer_sdf {

// HTML with {{placeholders}}.
extern const char kInspectorPage[];
extern const char kInspectorStyle[];
extern const char kInspectorScript[];

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_REPORT_INSPECTOR_TEMPLATE_H_
