#pragma once
// YAML nodes whose every complaint names file and line.

#include <yaml-cpp/yaml.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ldso {

/// A value of a plan: what it is called in messages, and where it stands.
class PlanNode {
 public:
  PlanNode(std::string origin, const YAML::Node& node, std::string name)
      : origin_(std::move(origin)), node_(node), name_(std::move(name)) {}

  /// The root of a YAML text. Throws Error naming the line if it is none.
  static PlanNode parse(const std::string& text, const std::string& origin);

  bool is_map() const { return node_.IsMap(); }
  const std::string& name() const { return name_; }

  // Throw Error if the value is of another kind.
  std::string text() const;    ///< Not empty.
  std::string scalar() const;  ///< Any single value.
  int whole_number(int least) const;
  double positive_number() const;
  bool yes_or_no() const;
  /// The index of the value in `words`.
  std::size_t one_of(const std::vector<std::string>& words) const;
  /// The elements of a list, or a value that is none as the only element. Not empty.
  std::vector<PlanNode> elements() const;
  /// (key, value) of a map, each key once.
  std::vector<std::pair<std::string, PlanNode>> entries() const;

  /// "file:line: 'name' problem; remedy"
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const;
  std::string where() const;  ///< "file:line"

 private:
  PlanNode child(const YAML::Node& node, std::string name) const { return {origin_, node, std::move(name)}; }

  std::string origin_;
  YAML::Node node_;
  std::string name_;
};

/// Throws Error with the nearest of the names if `key` is none of them.
void check_key(const PlanNode& value, const std::string& key, const std::vector<std::string>& names);

}  // namespace ldso
