// Published figures.

#include "experiment/summary/published.h"
#include "fuzz_target.h"

LDSO_FUZZ_TARGET(published_yaml) {
  const auto all =
      ldso::fuzz::accepted([&] { return ldso::read_published(ldso::fuzz::scratch_file("published.yaml", input)); });
  if (!all) return;
  for (const ldso::PublishedResults& results : *all) {
    for (const auto& [name, value] : results.values) {
      ldso::fuzz::expect(!value || std::isfinite(*value), "a published figure is finite");
      results.value_of(name, 100.0);
    }
  }
}
