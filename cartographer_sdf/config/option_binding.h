// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Binds the fields of a struct to the keys of a Lua table in one place, for
// reading and for writing. Beside the struct, in its namespace:
//
//   template <typename Visitor>
//   void VisitOptions(Visitor& visit, FooOptions& options) {
//     visit("radius_meters", options.radius_meters);
//     visit("bar", options.bar);  // another such struct: a nested table
//   }
//   // A sentence that begins with the offending key, or nothing.
//   std::string Validate(const FooOptions& options);
//
// and for an enum: std::vector<std::pair<std::string, Enum>> OptionNames(Enum).
// The table must have exactly the bound keys, with values of the right type.

#ifndef CARTOGRAPHER_SDF_CONFIG_OPTION_BINDING_H_
#define CARTOGRAPHER_SDF_CONFIG_OPTION_BINDING_H_

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cartographer_sdf/config/lua_dictionary.h"
#include "glog/logging.h"

namespace cartographer_sdf {

class OptionReader {
 public:
  // `path` is that of the table, for errors: "TABLE.key.key".
  OptionReader(const LuaTable& table, const std::string& path)
      : table_(table), path_(path) {}

  void operator()(const char* key, double& option);
  void operator()(const char* key, int& option);
  void operator()(const char* key, bool& option);
  void operator()(const char* key, std::string& option);
  void operator()(const char* key, std::vector<double>& option);
  template <typename T>
  void operator()(const char* key, T& option);

  // The first thing wrong so far; where everything was visited, this includes
  // keys that are not bound.
  [[nodiscard]] std::string Error() const;
  void AddError(const std::string& error);

 private:
  // Null, with an error, where it is missing or of another type.
  template <typename T>
  const T* Find(const char* key, const char* type_name);
  const LuaTable* FindTable(const char* key);
  [[nodiscard]] std::string PathOf(const std::string& key) const;
  // Index of the value among `names`, 0 with an error where it is none of them.
  size_t FindName(const char* key, const std::vector<std::string>& names);

  const LuaTable& table_;
  const std::string path_;
  std::vector<std::string> visited_;
  std::string error_;
};

// What is wrong with the table, or nothing.
template <typename T>
[[nodiscard]] std::string ReadTable(const LuaTable& table,
                                    const std::string& path, T& options) {
  OptionReader reader(table, path);
  VisitOptions(reader, options);
  if (std::string error = reader.Error(); !error.empty()) return error;
  const std::string error = Validate(options);
  return error.empty() ? error : path + "." + error;
}

template <typename T>
void OptionReader::operator()(const char* const key, T& option) {
  if constexpr (std::is_enum_v<T>) {
    std::vector<std::string> names;
    const std::vector<std::pair<std::string, T>> options = OptionNames(T());
    for (const auto& [name, unused] : options) names.push_back(name);
    option = options[FindName(key, names)].second;
  } else {
    const LuaTable* const table = FindTable(key);
    if (table != nullptr) AddError(ReadTable(*table, PathOf(key), option));
  }
}

template <typename T>
[[nodiscard]] absl::StatusOr<T> ReadOptions(const LuaDictionary& dictionary) {
  T options;
  const std::string error =
      ReadTable(dictionary.table, dictionary.name, options);
  if (error.empty()) return options;
  return absl::InvalidArgumentError("configuration file " + dictionary.path +
                                    ": " + error);
}

class OptionWriter {
 public:
  void operator()(const char* key, double& option);
  void operator()(const char* key, int& option);
  void operator()(const char* key, bool& option);
  void operator()(const char* key, std::string& option);
  void operator()(const char* key, std::vector<double>& option);
  template <typename T>
  void operator()(const char* key, T& option) {
    if constexpr (std::is_enum_v<T>) {
      std::string name;
      for (const auto& entry : OptionNames(option)) {
        if (entry.second == option) name = entry.first;
      }
      CHECK(!name.empty()) << key << " has no name";
      (*this)(key, name);
    } else {
      Open(key);
      VisitOptions(*this, option);
      Close();
    }
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void Open(const char* key);
  void Close();
  void Write(const char* key, const std::string& value);

  int depth_ = 0;
  std::string text_;
};

// Lua that assigns the options to `name`; reading it gives the same options.
template <typename T>
[[nodiscard]] std::string FormatOptions(const std::string& name, T options) {
  OptionWriter writer;
  writer(name.c_str(), options);
  return writer.text();
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CONFIG_OPTION_BINDING_H_
