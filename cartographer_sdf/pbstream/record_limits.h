// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Bounds on the memory that decoding a record takes: it grows with the number
// of fields, of which two bytes may be one.

#ifndef CARTOGRAPHER_SDF_PBSTREAM_RECORD_LIMITS_H_
#define CARTOGRAPHER_SDF_PBSTREAM_RECORD_LIMITS_H_

#include <cstdint>
#include <string>

namespace google::protobuf {
class Descriptor;
}

namespace cartographer_sdf {

// Some three million constraints.
constexpr int64_t kMaxNumFields = int64_t{1} << 26;

// Whether a serialized message has more fields than that, those of messages in
// it included. Of malformed bytes, only those before the damage count. Small
// records are not looked at.
[[nodiscard]] bool HasTooManyFields(const google::protobuf::Descriptor& type,
                                    const std::string& record,
                                    int64_t max_num_fields = kMaxNumFields);

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_PBSTREAM_RECORD_LIMITS_H_
