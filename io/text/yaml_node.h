#pragma once

// YAML whose every complaint names file and line: all YAML is read through it.

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace YAML {
class Node;
}

namespace ldso {

/// A value: what it is called in messages, and where it stands.
class YamlNode {
 public:
  /// The root of a YAML text, `name` in messages. Throws Error naming the line if it is none, if
  /// it is no UTF-8, or if it contains itself or repeats itself without end by aliases.
  static YamlNode parse(const std::string& text, const std::string& origin, std::string name);
  /// Of a file, which may begin with OpenCV's "%YAML:1.0", which is not YAML. Throws Error if it cannot be read.
  static YamlNode read(const std::filesystem::path& path, std::string name);

  bool is_map() const;
  bool is_list() const;
  bool is_scalar() const;
  bool is_null() const;
  const std::string& name() const { return name_; }

  // Throw Error if the value is of another kind.
  std::string text() const;    ///< Not empty.
  std::string scalar() const;  ///< Any single value.
  int whole_number(int least, int most = 1'000'000'000) const;
  double number() const;  ///< Finite.
  double positive_number() const;
  bool yes_or_no() const;
  /// The index of the value in `words`.
  std::size_t one_of(const std::vector<std::string>& words) const;
  /// `count` finite numbers.
  std::vector<double> numbers(std::size_t count) const;
  /// Finite numbers of a list, as many as there are.
  std::vector<double> all_numbers() const;
  /// The elements of a list, or a value that is none as the only element. Not empty.
  std::vector<YamlNode> elements() const;
  /// (key, value) of a map, each key once.
  std::vector<std::pair<std::string, YamlNode>> entries() const;
  /// The value of a key that has to be there.
  YamlNode at(const std::string& key) const;
  /// Of a map.
  bool contains(const std::string& key) const;

  /// "file:line: 'name' problem; remedy"
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const;
  /// Throws Error with the nearest of the names if `key`, whose value this is, is none of them.
  void check_key(const std::string& key, const std::vector<std::string>& names) const;
  std::string where() const;  ///< "file:line"

 private:
  YamlNode(std::string origin, const YAML::Node& node, std::string name);
  YamlNode child(const YAML::Node& node, std::string name) const { return {origin_, node, std::move(name)}; }

  std::string origin_;
  std::shared_ptr<const YAML::Node> node_;  ///< Here alone so that others need not know the library.
  std::string name_;
};

}  // namespace ldso
