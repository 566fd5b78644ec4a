// results.json and results.csv of experiments.

#include "experiment/results/results_file.h"
#include "experiment/results/csv.h"
#include "fuzz_target.h"

using namespace ldso;

LDSO_FUZZ_TARGET(results_file) {
  for (const std::string kind : {"json", "csv"}) {
    const auto results = fuzz::accepted([&] { return read_results(fuzz::scratch_file("results." + kind, input)); });
    if (!results) continue;
    const std::string json = results_json(*results), csv = results_csv(*results);
    fuzz::expect(results_json(read_results(fuzz::scratch_file("again.json", json))) == json,
                 "written results read back as they were");
    fuzz::expect(read_results(fuzz::scratch_file("again.csv", csv)).size() == results->size(), "as many of them");
  }
  const auto rows = fuzz::accepted([&] { return parse_csv(input); });
  if (!rows) return;
  std::string text;
  for (const CsvRow& row : *rows) text += csv_line(row);
  fuzz::expect(parse_csv(text) == *rows, "written rows read back as they were");
}
