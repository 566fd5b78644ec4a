#include "ldso/settings.h"

#include <cmath>
#include <concepts>
#include <map>
#include <sstream>
#include <string>
#include <string_view>

#include "ldso/error.h"
#include "settings/settings_ranges.h"

namespace ldso {
namespace {

/// Beyond any use; keeps sums of squares of the settings finite.
constexpr double kHuge = 1e15;

const std::map<std::string, SettingRange, std::less<>>& ranges() {
  static const std::map<std::string, SettingRange, std::less<>> kTable{
      {"threads", {1, 256}},
      {"selection.candidates", {50, 100000}},
      {"selection.corner_quality", {0, 1}},
      {"selection.corner_radius", {1, 100}},
      {"selection.corner_cell", {4, 1000}},
      {"selection.gradient_threshold", {0, 255}},
      {"selection.block_size", {4, 1000}},
      {"selection.seed", {0, 2147483647}},
      {"photometry.overexposed", {1, 256}},
      {"photometry.prior_a", {0, kHuge}},
      {"photometry.prior_b", {0, kHuge}},
      {"photometry.unknown_prior_a", {0, kHuge}},
      {"photometry.unknown_prior_b", {0, kHuge}},
      {"self_calibration.frames", {0, kHuge}},
      {"self_calibration.passes", {1, 20}},
      {"self_calibration.least_windows", {1, kHuge}},
      {"self_calibration.significance", {0, kHuge}},
      {"self_calibration.least_shift", {0, kHuge}},
      {"self_calibration.least_readout_ms", {0, kHuge}},
      {"window.iterations", {1, 100}},
      {"window.marginalization_weight", {0, 1}},
      {"window.focal_prior", {0, kHuge}},
      {"window.center_prior", {0, kHuge}},
      {"window.idepth_prior", {0, kHuge}},
      {"window.least_idepth_hessian", {0, kHuge}},
      {"window.active_points", {100, 100000}},
      {"keyframes.window_min", {2, 50}},
      {"keyframes.window_max", {3, 50}},
      {"keyframes.translation_weight", {0, 1000}},
      {"keyframes.rotation_weight", {0, 1000}},
      {"keyframes.brightness_weight", {0, 1000}},
      {"keyframes.density", {0.001, 1000}},
      {"keyframes.least_visible", {0, 1}},
      {"keyframes.brightness_limit", {0.01, 100}},
      {"tracking.cutoff", {1, 255}},
      {"tracking.good_ratio", {1, 100}},
      {"tracking.lost_rmse", {1, 255}},
      {"tracking.least_in_view", {0, 1}},
      {"tracing.search_length", {0.001, 1}},
      {"tracing.least_quality", {1, 1000}},
      {"tracing.largest_interval", {0.1, 1000}},
      {"tracing.least_idepth_hessian", {0, kHuge}},
      {"initializer.plenty_tracked", {0, 1}},
      {"initializer.good_parallax_angle", {0, 90}},
      {"initializer.points", {50, 100000}},
      {"initializer.min_parallax", {0, 1000}},
      {"initializer.min_parallax_angle", {0, 90}},
      {"initializer.good_parallax_angle", {0, 90}},
      {"initializer.plenty_tracked", {0, 1}},
      {"initializer.patience", {1, 1000000}},
      {"initializer.max_cost_ratio", {0, 1000}},
      {"initializer.max_direction_stddev", {0, 180}},
      {"initializer.min_inliers", {0, 1}},
      {"initializer.min_runner_up", {0, 1000}},
      {"initializer.max_ambiguous", {0, 1000000}},
      {"initializer.max_residual", {0, 1000}},
      {"initializer.max_idepth_stddev", {0, 1000}},
      {"initializer.min_good", {0, 1}},
      {"initializer.min_tracked", {0, 1}},
      {"initializer.max_frames", {2, 1000000}},
      {"loops.max_candidates", {1, 100}},
      {"loops.spacing", {1, 1000000}},
      {"loops.min_inliers", {7, 1000000}},
      {"loops.min_depth_inliers", {3, 1000000}},
      {"loops.min_seen_share", {0, 1}},
      {"loops.min_covered_cells", {0, 1}},
      {"loops.max_drift", {0, 1000000}},
  };
  return kTable;
}

std::string text(double value) {
  std::ostringstream stream;
  stream.precision(12);
  stream << value;
  return stream.str();
}

/// Compares every number with its range; a group visits its own fields under its name.
class RangeCheck {
 public:
  explicit RangeCheck(std::string prefix) : prefix_(std::move(prefix)) {}

  template <class Value>
  void operator()(const char* name, const Value& value) const {
    if constexpr (std::same_as<Value, bool> || std::is_enum_v<Value> || std::same_as<Value, std::string>) {
      return;
    } else if constexpr (std::is_arithmetic_v<Value>) {
      check(prefix_ + name, static_cast<double>(value));
    } else {
      Value::visit_fields(value, RangeCheck(prefix_ + name + "."));
    }
  }

 private:
  static void check(const std::string& key, double value) {
    // A setting without a range of its own has at least to be a number.
    const SettingRange range = setting_range(key).value_or(SettingRange{-kHuge, kHuge});
    if (value >= range.least && value <= range.largest) return;
    throw Error("setting " + key, text(value) + " is out of range",
                "allowed is " + text(range.least) + " to " + text(range.largest));
  }

  std::string prefix_;
};

}  // namespace

std::optional<SettingRange> setting_range(std::string_view key) {
  const auto found = ranges().find(key);
  if (found == ranges().end()) return std::nullopt;
  return found->second;
}

void Settings::validate() const {
  visit_fields(*this, RangeCheck(""));
  if (keyframes.window_min > keyframes.window_max) {
    throw Error("setting keyframes.window_min", std::to_string(keyframes.window_min) + " is out of range",
                "allowed is at most keyframes.window_max, " + std::to_string(keyframes.window_max));
  }
}

}  // namespace ldso
