#include "report/html.h"

#include <gtest/gtest.h>

namespace ldso::html {
namespace {

TEST(Html, TextIsEscapedWhereverItStands) {
  const std::string evil = "</script><img src=x onerror=\"a&b\">\x01";
  const std::string safe = "&lt;/script&gt;&lt;img src=x onerror=&quot;a&amp;b&quot;&gt; ";
  EXPECT_EQ(escape(evil), safe);
  EXPECT_EQ(element("p", evil, "note"), "<p class=\"note\">" + safe + "</p>");
  EXPECT_NE(section("id", evil, "<b></b>").find("<h2>" + safe + "</h2>\n<b></b>"), std::string::npos);
  EXPECT_NE(details(evil, "").find("<summary>" + safe + "</summary>"), std::string::npos);
  const std::string made = table({evil}, {{{evil}}});
  EXPECT_NE(made.find("<th class=\"left\">" + safe), std::string::npos);
  EXPECT_NE(made.find("<td class=\"left\">" + safe), std::string::npos);
  EXPECT_EQ(made.find("<img"), std::string::npos);
}

TEST(Html, TableKeepsWhatIsHtmlAlready) {
  const std::string made = table({"a", "b"}, {{{"1", "bold"}, {"", "", "<i>x</i>"}}});
  EXPECT_NE(made.find("<td class=\"bold left\">1</td><td><i>x</i></td>"), std::string::npos) << made;
}

}  // namespace
}  // namespace ldso::html
