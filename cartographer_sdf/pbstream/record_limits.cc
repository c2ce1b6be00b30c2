// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/pbstream/record_limits.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>

namespace cartographer_sdf {
namespace {

using ::google::protobuf::Descriptor;
using ::google::protobuf::FieldDescriptor;
using ::google::protobuf::internal::WireFormatLite;

bool SkipValue(const uint32_t tag,
               google::protobuf::io::CodedInputStream* const input) {
  uint64_t ignored = 0;
  switch (WireFormatLite::GetTagWireType(tag)) {
    case WireFormatLite::WIRETYPE_VARINT:
      return input->ReadVarint64(&ignored);
    case WireFormatLite::WIRETYPE_FIXED64:
      return input->Skip(8);
    case WireFormatLite::WIRETYPE_FIXED32:
      return input->Skip(4);
    default:
      // The fields of a group follow by themselves.
      return true;
  }
}

// Counts down; stops at zero, or where the bytes are malformed.
void CountFields(const Descriptor& type,
                 google::protobuf::io::CodedInputStream* const input,
                 int64_t* const num_left) {
  while (*num_left > 0) {
    const uint32_t tag = input->ReadTag();
    if (tag == 0) return;
    --*num_left;
    if (WireFormatLite::GetTagWireType(tag) !=
        WireFormatLite::WIRETYPE_LENGTH_DELIMITED) {
      if (!SkipValue(tag, input)) return;
      continue;
    }
    uint32_t length = 0;
    if (!input->ReadVarint32(&length) || length > uint32_t{INT32_MAX}) return;
    const FieldDescriptor* const field =
        type.FindFieldByNumber(WireFormatLite::GetTagFieldNumber(tag));
    if (field != nullptr && field->message_type() != nullptr) {
      const auto limit = input->PushLimit(static_cast<int>(length));
      CountFields(*field->message_type(), input, num_left);
      input->Skip(input->BytesUntilLimit());
      input->PopLimit(limit);
    } else if (!input->Skip(static_cast<int>(length))) {
      return;
    }
  }
}

}  // namespace

bool HasTooManyFields(const Descriptor& type, const std::string& record,
                      const int64_t max_num_fields) {
  if (static_cast<int64_t>(record.size()) <= max_num_fields) return false;
  google::protobuf::io::CodedInputStream input(
      reinterpret_cast<const uint8_t*>(record.data()),
      static_cast<int>(record.size()));
  int64_t num_left = max_num_fields + 1;
  CountFields(type, &input, &num_left);
  return num_left == 0;
}

}  // namespace cartographer_sdf
