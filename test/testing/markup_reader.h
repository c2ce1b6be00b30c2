// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#ifndef TEST_TESTING_MARKUP_READER_H_
#define TEST_TESTING_MARKUP_READER_H_

#include <string>
#include <vector>

// What is wrong with the markup, or nothing: every element must be closed in
// order, every attribute quoted, no < or bare & in texts.
inline std::string MarkupError(const std::string& markup) {
  std::vector<std::string> open;
  for (size_t i = 0; i < markup.size(); ++i) {
    if (markup[i] == '&' && markup.substr(i, 10).find(';') == std::string::npos)
      return "bare & at " + markup.substr(i, 40);
    if (markup[i] != '<') continue;
    const size_t begin = i;
    bool in_quotes = false;
    while (++i < markup.size() && (in_quotes || markup[i] != '>')) {
      if (markup[i] == '"') in_quotes = !in_quotes;
      if (markup[i] == '<') return "< in " + markup.substr(begin, 60);
    }
    if (i >= markup.size()) return "no end of " + markup.substr(begin, 40);
    const std::string tag = markup.substr(begin + 1, i - begin - 1);
    if (tag.empty()) return "empty tag";
    if (tag[0] == '!') continue;
    for (size_t k = tag.find('='); k != std::string::npos;
         k = tag.find('=', tag.find('"', k + 2) + 1)) {
      if (tag[k + 1] != '"') return "unquoted in " + tag.substr(0, 60);
    }
    const size_t start = tag[0] == '/' ? 1 : 0;
    const std::string name =
        tag.substr(start, tag.find_first_of(" /", start) - start);
    if (tag[0] == '/') {
      if (open.empty() || open.back() != name) return "unexpected <" + tag;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
      // Their contents are no markup.
      if (name == "script" || name == "style") {
        const size_t end = markup.find("</" + name, i);
        if (end == std::string::npos) return "not closed: " + name;
        i = end - 1;
      }
    }
  }
  return open.empty() ? "" : "not closed: " + open.back();
}

#endif  // TEST_TESTING_MARKUP_READER_H_
