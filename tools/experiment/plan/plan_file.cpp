#include "experiment/plan/plan_file.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "experiment/jobs/job_file.h"
#include "io/text/nearest_name.h"
#include "io/text/yaml_node.h"
#include "ldso/error.h"
#include "ldso/io/settings_file.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

const Names kPlanKeys{"title",       "root", "datasets", "strategies", "loops",    "variants", "directions",
                      "repetitions", "vary", "threads",  "jobs",       "settings", "config"};
const Names kSequenceKeys{"path", "needs",        "start",  "end",      "stride", "calib",
                          "fps",  "ground_truth", "metric", "settings", "config"};
const Names kStrategies{"corners", "gradient", "random"};
const Names kDirections{"forward", "backward"};
const Names kVary{"start", "seed", "none"};
/// Each is a folder with a trajectory and a map in it.
constexpr int kMostJobs = 100'000;

const Names kMetrics{to_string(JobMetric::kAte), to_string(JobMetric::kTumMono)};

Names with(Names names, const Names& more) {
  names.insert(names.end(), more.begin(), more.end());
  return names;
}

/// Names become folders of the experiment.
std::string name_of(const YamlNode& value) {
  std::string name = value.text();
  const bool good = name.front() != '.' && std::all_of(name.begin(), name.end(), [](char c) {
                      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
                    });
  if (!good) value.fail("is '" + name + "'", "letters, digits, '_', '-' and '.' make a name");
  return name;
}

/// What a dataset says of all its sequences and a sequence of itself.
struct SequenceKeys {
  std::string path = "{name}";
  Names needs;
  DatasetOptions playback;
  JobMetric metric = JobMetric::kAte;
  std::optional<std::string> calib, ground_truth;
  std::optional<fs::path> config;
  std::vector<std::string> settings;
};

std::string with_name(std::string text, const std::string& name) {
  static const std::string kPlaceholder = "{name}";
  for (std::size_t at = 0; (at = text.find(kPlaceholder, at)) != std::string::npos; at += name.size())
    text.replace(at, kPlaceholder.size(), name);
  return text;
}

class PlanReader {
 public:
  PlanReader(fs::path folder, const PlanRoots& roots) : folder_(std::move(folder)), roots_(roots) {}

  ExperimentPlan read(const std::string& text, const std::string& origin) {
    plan_.origin = origin;
    const YamlNode root = YamlNode::parse(text, origin, "the plan");
    if (!root.is_map()) root.fail("has no lines `key: value`", "see docs/experiments.md for the keys");
    std::optional<YamlNode> datasets;
    for (const auto& [key, value] : root.entries()) {
      value.check_key(key, kPlanKeys);
      if (key == "datasets") {
        datasets = value;
      } else {
        read_plan_key(key, value);
      }
    }
    if (!datasets) root.fail("has no datasets", "give `datasets: {NAME: {root: FOLDER, sequences: [..]}}`");
    make_variants(root);
    read_datasets(*datasets);
    check_number(root);
    check_settings();
    return std::move(plan_);
  }

 private:
  void read_plan_key(const std::string& key, const YamlNode& value) {
    if (key == "title") plan_.title = value.text();
    if (key == "root") root_ = value.text();
    if (key == "repetitions") plan_.repetitions = value.whole_number(1, kMostJobs);
    if (key == "threads") plan_.threads = value.whole_number(1);
    if (key == "jobs") plan_.jobs = value.whole_number(1);
    if (key == "vary") plan_.vary = static_cast<Vary>(value.one_of(kVary));
    if (key == "settings") read_settings_of(value, "", common_.settings);
    if (key == "config") common_.config = file_of(value);
    if (key == "directions") read_directions(value);
    if (key == "strategies") strategies_ = value;
    if (key == "loops") loops_ = value;
    if (key == "variants") variants_ = value;
  }

  void read_directions(const YamlNode& value) {
    plan_.directions.clear();
    for (const YamlNode& element : value.elements()) {
      const bool reverse = element.one_of(kDirections) == 1;
      if (std::find(plan_.directions.begin(), plan_.directions.end(), reverse) != plan_.directions.end())
        element.fail("names a direction twice", "remove one");
      plan_.directions.push_back(reverse);
    }
  }

  // Variants: listed one by one, or all strategies with all that `loops` says.

  void make_variants(const YamlNode& root) {
    if (variants_) {
      for (const auto& other : {strategies_, loops_}) {
        if (other) other->fail("stands beside 'variants'", "a variant says its own strategy and loops; remove it");
      }
      for (const YamlNode& element : variants_->elements()) add_variant(read_variant(element), element);
      return;
    }
    const std::vector<YamlNode> loops = loops_ ? loops_->elements() : std::vector<YamlNode>{};
    const std::vector<YamlNode> strategies = strategies_ ? strategies_->elements() : std::vector<YamlNode>{};
    const std::size_t rows = std::max<std::size_t>(strategies.size(), 1);
    const std::size_t columns = std::max<std::size_t>(loops.size(), 1);
    for (std::size_t i = 0; i < rows * columns; ++i) {
      PlanVariant variant;
      if (strategies_) variant.strategy = kStrategies[strategies[i / columns].one_of(kStrategies)];
      if (loops_) variant.loops = loops[i % columns].yes_or_no();
      variant.name = default_name(variant);
      add_variant(variant, strategies_ ? strategies[i / columns] : loops_ ? loops[i % columns] : root);
    }
  }

  static std::string default_name(const PlanVariant& variant) {
    return variant.strategy + (variant.loops ? "" : "_no_loops");
  }

  PlanVariant read_variant(const YamlNode& node) {
    static const Names kKeys{"name", "strategy", "loops", "settings"};
    PlanVariant variant;
    for (const auto& [key, value] : node.entries()) {
      value.check_key(key, kKeys);
      if (key == "name") variant.name = name_of(value);
      if (key == "strategy") variant.strategy = kStrategies[value.one_of(kStrategies)];
      if (key == "loops") variant.loops = value.yes_or_no();
      if (key == "settings") read_settings_of(value, "", variant.settings);
    }
    if (variant.name.empty()) variant.name = default_name(variant);
    return variant;
  }

  void add_variant(PlanVariant variant, const YamlNode& node) {
    for (const PlanVariant& other : plan_.variants) {
      if (other.name == variant.name)
        node.fail("makes the variant '" + variant.name + "' twice", "remove one or give it another name");
    }
    plan_.variants.push_back(std::move(variant));
  }

  // Datasets and their sequences.

  void read_datasets(const YamlNode& datasets) {
    const auto entries = datasets.entries();
    if (entries.empty()) datasets.fail("is empty", "name at least one dataset");
    check_roots(entries);
    for (const auto& [name, node] : entries) read_dataset(name, node, entries.size() == 1);
    if (plan_.sequences.empty()) datasets.fail("has no sequences", "list some below `sequences:`");
  }

  void check_roots(const std::vector<std::pair<std::string, YamlNode>>& datasets) const {
    Names names;
    for (const auto& [name, node] : datasets) names.push_back(name);
    if (roots_.only && datasets.size() > 1) {
      throw Error("--root " + roots_.only->string(), plan_.origin + " has several datasets",
                  "give each its own, e.g. --root " + names.front() + "=" + roots_.only->string());
    }
    for (const auto& [name, folder] : roots_.by_dataset) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        throw Error("--root " + name + "=" + folder.string(), plan_.origin + " has no dataset '" + name + "'",
                    "did you mean '" + nearest_name(name, names) + "'?");
      }
    }
  }

  void read_dataset(const std::string& name, const YamlNode& node, bool only) {
    static const Names kKeys = with({"root", "download", "sequences"}, kSequenceKeys);
    SequenceKeys keys = common_;
    std::optional<YamlNode> root, sequences;
    std::string download;
    for (const auto& [key, value] : node.entries()) {
      value.check_key(key, kKeys);
      if (key == "root") root = value;
      if (key == "sequences") sequences = value;
      if (key == "download") download = value.text();
      read_sequence_key(key, value, keys);
    }
    if (!sequences) node.fail("has no sequences", "give `sequences: [NAME, ..]`");
    const fs::path folder = root_of(name, root, only);
    for (const YamlNode& element : sequences->elements()) {
      plan_.sequences.push_back(read_sequence(element, keys, folder));
      plan_.sequences.back().dataset = name;
      plan_.sequences.back().download = download;
    }
  }

  /// Empty if nothing says it: that is one of the things that are missing on this machine, not a mistake of the plan.
  fs::path root_of(const std::string& name, const std::optional<YamlNode>& root, bool only) const {
    const auto given = roots_.by_dataset.find(name);
    if (given != roots_.by_dataset.end()) return absolute(fs::current_path(), given->second);
    if (only && roots_.only) return absolute(fs::current_path(), *roots_.only);
    if (root) return absolute(folder_, root->text());
    if (root_) return absolute(folder_, *root_);
    return {};
  }

  void read_sequence_key(const std::string& key, const YamlNode& value, SequenceKeys& keys) {
    if (key == "path") keys.path = value.text();
    if (key == "start") keys.playback.start = value.whole_number(0);
    if (key == "end") keys.playback.end = end_of(value);
    if (key == "stride") keys.playback.stride = value.whole_number(1);
    if (key == "fps") keys.playback.fps = value.positive_number();
    if (key == "calib") keys.calib = value.text();
    if (key == "ground_truth") keys.ground_truth = value.text();
    if (key == "metric") keys.metric = parse_job_metric(kMetrics[value.one_of(kMetrics)]);
    if (key == "settings") read_settings_of(value, "", keys.settings);
    if (key == "config") keys.config = file_of(value);
    if (key == "needs") {
      keys.needs.clear();
      for (const YamlNode& element : value.elements()) keys.needs.push_back(element.text());
    }
  }

  static int end_of(const YamlNode& value) {
    const int end = value.whole_number(-1000000000);
    if (end == 0) value.fail("leaves no frame", "count from 1, or below 0 from the sequence's end");
    return end;
  }

  PlanSequence read_sequence(const YamlNode& node, SequenceKeys keys, const fs::path& root) {
    static const Names kKeys = with({"name"}, kSequenceKeys);
    PlanSequence sequence;
    if (node.is_map()) {
      for (const auto& [key, value] : node.entries()) {
        value.check_key(key, kKeys);
        if (key == "name") sequence.name = name_of(value);
        read_sequence_key(key, value, keys);
      }
      if (sequence.name.empty()) node.fail("lists a sequence without a name", "give `name: NAME`");
    } else {
      sequence.name = name_of(node);
    }
    for (const PlanSequence& other : plan_.sequences) {
      if (other.name == sequence.name)
        node.fail("lists '" + sequence.name + "' twice", "remove one or give it another name");
    }
    if (!root.empty()) sequence.path = absolute(root, with_name(keys.path, sequence.name));
    for (const std::string& need : keys.needs) sequence.needs.push_back(with_name(need, sequence.name));
    sequence.playback = keys.playback;
    sequence.metric = keys.metric;
    sequence.config = keys.config;
    sequence.settings = keys.settings;
    if (keys.calib) sequence.playback.calibration_file = absolute(sequence.path, with_name(*keys.calib, sequence.name));
    if (keys.ground_truth)
      sequence.ground_truth = absolute(sequence.path, with_name(*keys.ground_truth, sequence.name));
    return sequence;
  }

  void check_number(const YamlNode& root) const {
    const std::size_t ways = plan_.variants.size() * plan_.directions.size() * plan_.sequences.size();
    if (static_cast<std::size_t>(plan_.repetitions) * ways <= static_cast<std::size_t>(kMostJobs)) return;
    root.fail("has more than " + std::to_string(kMostJobs) + " jobs", "give fewer repetitions, variants or sequences");
  }

  // Settings.

  /// Nested or dotted; each checked by itself.
  void read_settings_of(const YamlNode& node, const std::string& prefix, std::vector<std::string>& settings) {
    for (const auto& [key, value] : node.entries()) {
      if (value.is_map()) {
        read_settings_of(value, prefix + key + ".", settings);
        continue;
      }
      check_setting(prefix + key, value);
      settings.push_back(prefix + key + "=" + value.scalar());
    }
  }

  static void check_setting(const std::string& key, const YamlNode& value) {
    static const std::vector<std::pair<std::string, std::string>> kOwn{
        {"selection.strategy", "strategies"}, {"loops.enabled", "loops"}, {"threads", "threads"}};
    for (const auto& [setting, plan_key] : kOwn) {
      if (key == setting) value.fail("is no setting of a plan", "use the plan's key '" + plan_key + "'");
    }
    Settings settings;
    try {
      set_setting(settings, key, value.scalar());
    } catch (const Error& error) {
      throw Error(value.where() + ": " + error.what());
    }
  }

  /// Ranges, of all that belongs together.
  void check_settings() const {
    for (const PlanSequence& sequence : plan_.sequences) {
      for (const PlanVariant& variant : plan_.variants) {
        Settings settings;
        settings.threads = plan_.threads;
        if (sequence.config) read_settings(*sequence.config, settings);
        for (const auto& list : {sequence.settings, variant.settings}) {
          for (const std::string& text : list) {
            const std::size_t equals = text.find('=');
            set_setting(settings, text.substr(0, equals), text.substr(equals + 1));
          }
        }
        try {
          settings.validate();
        } catch (const Error& error) {
          throw Error(plan_.origin + ": " + sequence.name + ", " + variant.name + ": " + error.what());
        }
      }
    }
  }

  fs::path file_of(const YamlNode& value) const {
    fs::path file = absolute(folder_, value.text());
    std::error_code error;
    if (!fs::is_regular_file(file, error))
      value.fail("names " + file.string() + ", which is no file", "check the path");
    return file;
  }

  static fs::path absolute(const fs::path& base, const fs::path& path) {
    fs::path normal = (base / path).lexically_normal();
    return normal.has_filename() ? normal : normal.parent_path();
  }

  fs::path folder_;
  const PlanRoots& roots_;
  ExperimentPlan plan_;
  SequenceKeys common_;
  std::optional<std::string> root_;
  std::optional<YamlNode> strategies_, loops_, variants_;
};

}  // namespace

PlanRoots parse_roots(const std::vector<std::string>& texts) {
  PlanRoots roots;
  for (const std::string& text : texts) {
    // A path may hold '=', the name of a dataset no '/'.
    const std::size_t equals = text.substr(0, text.find('/')).find('=');
    const std::string folder = equals == std::string::npos ? text : text.substr(equals + 1);
    if (folder.empty()) throw Error("--root " + text, "names no folder", "write --root FOLDER or --root NAME=FOLDER");
    const bool is_new =
        equals == std::string::npos ? !roots.only : roots.by_dataset.emplace(text.substr(0, equals), folder).second;
    if (!is_new) throw Error("--root " + text, "is given twice", "give one folder for each dataset");
    if (equals == std::string::npos) roots.only = folder;
  }
  return roots;
}

ExperimentPlan read_plan(const fs::path& file, const PlanRoots& roots) {
  return parse_plan(read_file(file), file.string(), fs::absolute(file).parent_path(), roots);
}

ExperimentPlan parse_plan(const std::string& text, const std::string& origin, const fs::path& folder,
                          const PlanRoots& roots) {
  return PlanReader(fs::absolute(folder), roots).read(text, origin);
}

}  // namespace ldso
