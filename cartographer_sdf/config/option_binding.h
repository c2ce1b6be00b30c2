// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

// Binds the fields of a struct to the keys of a Lua table in one place, for
// reading and writing. Define beside the struct, in its namespace:
//
//   inline void VisitOptions(OptionVisitor& visit, FooOptions& options) {
//     visit("radius_meters", options.radius_meters);
//     visit("bar", options.bar);  // another such struct: a nested table
//   }
//   // A sentence that begins with the offending key, or nothing.
//   std::string Validate(const FooOptions& options);
//
// and for an enum: std::vector<std::string> OptionNames(Enum), in its order.
// The table must have exactly the bound keys, with values of the right type.

#ifndef CARTOGRAPHER_SDF_CONFIG_OPTION_BINDING_H_
#define CARTOGRAPHER_SDF_CONFIG_OPTION_BINDING_H_

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "cartographer_sdf/config/lua_dictionary.h"
#include "cartographer_sdf/report/report_options.h"

namespace cartographer_sdf {

// Visits the options of a struct and of its nested structs, in order.
class OptionVisitor {
 public:
  virtual ~OptionVisitor() = default;

  void operator()(const char* key, double& option) { Visit(key, option); }
  void operator()(const char* key, int& option) { Visit(key, option); }
  void operator()(const char* key, bool& option) { Visit(key, option); }
  template <typename T>
  void operator()(const char* const key, T& option) {
    if constexpr (std::is_enum_v<T>) {
      int index = static_cast<int>(option);
      VisitName(key, OptionNames(option), index);
      option = static_cast<T>(index);
    } else if (Enter(key)) {
      VisitOptions(*this, option);
      Leave(Validate(option));
    }
  }

 private:
  virtual void Visit(const char* key, double& option) = 0;
  virtual void Visit(const char* key, int& option) = 0;
  virtual void Visit(const char* key, bool& option) = 0;
  // `index` refers to `names`.
  virtual void VisitName(const char* key, const std::vector<std::string>& names,
                         int& index) = 0;
  // Called before and after a nested struct, which is skipped if Enter returns
  // false; `problem` is the result of its Validate.
  virtual bool Enter(const char* key) = 0;
  virtual void Leave(const std::string& problem) = 0;
};

class OptionReader : public OptionVisitor {
 public:
  explicit OptionReader(const LuaDictionary& dictionary)
      : dictionary_(dictionary) {}

  // The first error in the file, or OK.
  [[nodiscard]] absl::Status Result() const;

 private:
  void Visit(const char* key, double& option) override;
  void Visit(const char* key, int& option) override;
  void Visit(const char* key, bool& option) override;
  void VisitName(const char* key, const std::vector<std::string>& names,
                 int& index) override;
  bool Enter(const char* key) override;
  void Leave(const std::string& problem) override;
  // Adds an error and returns null if the value is missing or of another type.
  template <typename T>
  const T* Find(const char* key, const char* type_name);
  [[nodiscard]] std::string PathOf(const char* key) const;
  void AddError(const std::string& path, const std::string& problem);

  const LuaDictionary& dictionary_;
  // The keys of the enclosing tables.
  std::vector<std::string> tables_;
  std::vector<std::string> visited_;
  std::string error_;
};

class OptionWriter : public OptionVisitor {
 public:
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void Visit(const char* key, double& option) override;
  void Visit(const char* key, int& option) override;
  void Visit(const char* key, bool& option) override;
  void VisitName(const char* key, const std::vector<std::string>& names,
                 int& index) override;
  bool Enter(const char* key) override;
  void Leave(const std::string& problem) override;
  void WriteLine(const std::string& line);

  int depth_ = 0;
  std::string text_;
};

// The options by their paths, e.g. "match.verification.min_score", as Lua
// writes their values.
class OptionLister : public OptionVisitor {
 public:
  [[nodiscard]] const std::vector<std::pair<std::string, std::string>>&
  options() const {
    return options_;
  }

 private:
  void Visit(const char* key, double& option) override;
  void Visit(const char* key, int& option) override;
  void Visit(const char* key, bool& option) override;
  void VisitName(const char* key, const std::vector<std::string>& names,
                 int& index) override;
  bool Enter(const char* key) override;
  void Leave(const std::string& problem) override;
  void Add(const char* key, const std::string& value);

  std::vector<std::string> tables_;
  std::vector<std::pair<std::string, std::string>> options_;
};

// Paths begin below the table of the options themselves.
template <typename T>
[[nodiscard]] std::vector<std::pair<std::string, std::string>> ListOptions(
    T options) {
  OptionLister lister;
  VisitOptions(lister, options);
  return lister.options();
}

// The options that differ from their defaults.
template <typename T>
[[nodiscard]] std::vector<ChangedOption> ListChangedOptions(const T& options) {
  const auto in_force = ListOptions(options);
  const auto defaults = ListOptions(T());
  std::vector<ChangedOption> changed;
  for (size_t k = 0; k < in_force.size(); ++k) {
    if (in_force[k].second == defaults[k].second) continue;
    changed.push_back(
        {in_force[k].first, in_force[k].second, defaults[k].second});
  }
  return changed;
}

// Loads the options in the table `name` of a file, see LoadLuaDictionary.
// Fields that are not visited keep their value in `options`.
template <typename T>
[[nodiscard]] absl::StatusOr<T> LoadTable(
    const std::vector<std::string>& directories, const std::string& basename,
    const char* const name, T options = T()) {
  const absl::StatusOr<LuaDictionary> dictionary =
      LoadLuaDictionary(directories, basename, name);
  if (!dictionary.ok()) return dictionary.status();
  OptionReader reader(*dictionary);
  reader(name, options);
  if (absl::Status status = reader.Result(); !status.ok()) return status;
  return options;
}

// Lua that assigns the options to `name`.
template <typename T>
[[nodiscard]] std::string FormatTable(const char* const name, T options) {
  OptionWriter writer;
  writer(name, options);
  return writer.text();
}

// A file that LoadTable reads.
template <typename T>
[[nodiscard]] std::string FormatFile(const char* const name, const T& options) {
  return FormatTable(name, options) + "\nreturn " + name + "\n";
}

}  // namespace cartographer_sdf

#endif  // CARTOGRAPHER_SDF_CONFIG_OPTION_BINDING_H_
