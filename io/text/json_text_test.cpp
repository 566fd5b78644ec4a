#include "io/text/json_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace ldso {
namespace {

using Json = nlohmann::json;

TEST(JsonText, AnOddNameDoesNotStopIt) {
  EXPECT_EQ(json_text(Json{{"name", "b\xe4r.png"}}), "{\"name\":\"b\xef\xbf\xbdr.png\"}");
}

TEST(JsonText, DeepOnesAreRefusedBeforeTheStackIsFull) {
  const std::string open(1'000'000, '['), close(1'000'000, ']');
  EXPECT_THROW(parse_json<Json>(open + close, "a.json"), Error);
  EXPECT_THROW(parse_json<Json>(open, "a.json"), Error);
  EXPECT_THROW(parse_json<Json>("[", "a.json"), Json::exception);
  EXPECT_EQ(parse_json<Json>(open.substr(0, 64) + close.substr(0, 64), "a.json").size(), 1u);
  // In a text brackets are letters.
  EXPECT_EQ(parse_json<Json>("[\"" + open + "\\\"" + open + "\"]", "a.json").size(), 1u);
}

}  // namespace
}  // namespace ldso
