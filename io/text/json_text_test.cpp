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

TEST(JsonText, WholeNumbersAreWholeAndHaveRoom) {
  EXPECT_EQ(json_value<int>(Json(-7)), -7);
  EXPECT_EQ(json_value<int>(Json(7.0)), 7);
  EXPECT_TRUE(json_value<bool>(Json(true)));
  for (const Json& bad : {Json(1e300), Json(0.5), Json(std::int64_t{1} << 40), Json("7"), Json()})
    EXPECT_THROW(json_value<int>(bad), Json::exception) << bad;
}

}  // namespace
}  // namespace ldso
