// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/markup.h"

#include <cstddef>

namespace cartographer_sdf {
namespace {

bool IsContinuation(const int byte) { return (byte & 0xc0) == 0x80; }

// Length of the well-formed UTF-8 sequence (Unicode, table 3-7) of a non-ASCII
// character at the beginning of the text; 0 where there is none.
size_t Utf8Length(const std::string_view text) {
  const auto byte = [&text](const size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
  };
  const int first = byte(0);
  const int second = byte(1);
  if (first >= 0xc2 && first <= 0xdf) {
    return IsContinuation(byte(1)) ? 2 : 0;
  }
  if (first >= 0xe0 && first <= 0xef) {
    const int low = first == 0xe0 ? 0xa0 : 0x80;
    const int high = first == 0xed ? 0x9f : 0xbf;
    return second >= low && second <= high && IsContinuation(byte(2)) ? 3 : 0;
  }
  if (first >= 0xf0 && first <= 0xf4) {
    const int low = first == 0xf0 ? 0x90 : 0x80;
    const int high = first == 0xf4 ? 0x8f : 0xbf;
    return second >= low && second <= high && IsContinuation(byte(2)) &&
                   IsContinuation(byte(3))
               ? 4
               : 0;
  }
  return 0;
}

std::string EscapeAscii(const char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      break;
  }
  const bool is_printable = c >= 0x20 && c != 0x7f;
  return std::string(1, is_printable || c == '\n' || c == '\t' ? c : '?');
}

}  // namespace

std::string EscapeMarkup(const std::string_view text) {
  std::string escaped;
  for (size_t i = 0; i < text.size();) {
    if (static_cast<unsigned char>(text[i]) < 0x80) {
      escaped += EscapeAscii(text[i++]);
      continue;
    }
    const size_t length = Utf8Length(text.substr(i));
    if (length == 0) {
      escaped += '?';
      ++i;
    } else {
      escaped += text.substr(i, length);
      i += length;
    }
  }
  return escaped;
}

}  // namespace cartographer_sdf
