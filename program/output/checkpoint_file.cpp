#include "output/checkpoint_file.h"

#include <nlohmann/json.hpp>

#include "io/text/json_text.h"
#include "ldso/error.h"

namespace ldso {

std::string describe_checkpoint(const std::string& text, const std::string& name) {
  try {
    const auto json = parse_json<nlohmann::json>(text, name);
    return std::to_string(json_value<int>(json.at("counts").at("frames"))) + " of " +
           std::to_string(json_value<int>(json.at("sequence").at("frames"))) + " frames, " +
           std::to_string(json_value<int>(json.at("counts").at("frames_with_pose"))) + " with a pose";
  } catch (const nlohmann::json::exception& error) {
    throw Error(name, std::string("it is damaged (") + error.what() + ")", "run the sequence again");
  }
}

}  // namespace ldso
