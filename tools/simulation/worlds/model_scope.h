#pragma once

// Idea: a world of few models, each seen again and again, is made by drawing the same random numbers for the same
// thing.

#include <cstdint>

#include "simulation/rendering/noise.h"

namespace ldso::simulation {

/// While it lives, `random` repeats what it gives to one of `models` models of a kind; after it `random` goes on as if
/// nothing had been drawn. Without models it changes nothing.
class ModelScope {
 public:
  ModelScope(Random& random, int models, std::uint64_t seed_of_kind) : random_(random), saved_(random) {
    is_model_ = models > 0;
    if (!is_model_) return;
    const auto model = static_cast<std::uint64_t>(saved_.index(models));
    random_ = Random(seed_of_kind, model);
  }
  ~ModelScope() {
    if (is_model_) random_ = saved_;
  }
  ModelScope(const ModelScope&) = delete;
  ModelScope& operator=(const ModelScope&) = delete;

 private:
  Random& random_;
  Random saved_;
  bool is_model_ = false;
};

}  // namespace ldso::simulation
