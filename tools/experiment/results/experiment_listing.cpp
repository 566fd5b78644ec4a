#include "experiment/results/experiment_listing.h"

#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "io/text/json_text.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kListingFile = "experiment.json";
constexpr std::string_view kBeginning = "{\n  \"title\":";

}  // namespace

void write_listing(const fs::path& experiment, const ExperimentListing& listing) {
  const fs::path file = experiment / kListingFile;
  refuse_other_file(file, {kBeginning}, "the list of an experiment");
  create_folder(experiment);
  const Json json{{"title", listing.title}, {"jobs", listing.jobs}};
  write_file(file, json_text(json, 2) + "\n");
}

ExperimentListing read_listing(const fs::path& experiment) {
  const fs::path path = experiment / kListingFile;
  std::error_code error;
  if (!fs::exists(path, error)) {
    throw Error(experiment.string(), std::string("is no folder of an experiment: there is no ") + kListingFile,
                "give the folder that `ldso experiment run` had by -o");
  }
  try {
    const Json json = parse_json<Json>(read_file(path), path.string());
    return {json.at("title").get<std::string>(), json.at("jobs").get<std::vector<std::string>>()};
  } catch (const Json::exception& problem) {
    throw Error(path.string(), std::string("is damaged (") + problem.what() + ")",
                "`ldso experiment run` writes it again");
  }
}

std::string shell_quoted(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted(1, '\'');
  for (const char c : word) {
    if (c == '\'') {
      quoted.append("'\\''");  // Out of the quotes, a quote, in again.
    } else {
      quoted.push_back(c);
    }
  }
  quoted += '\'';
  return quoted;
}

std::string shell_quoted(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    line += shell_quoted(word);
  }
  return line;
}

}  // namespace ldso
