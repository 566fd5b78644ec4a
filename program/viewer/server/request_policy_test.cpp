#include "viewer/server/request_policy.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

TEST(RequestPolicy, OwnPagesAreAllowed) {
  const RequestPolicy policy;
  EXPECT_EQ(judge(policy, {"/", "127.0.0.1:8421", ""}, true), Verdict::kAllowed);
  EXPECT_EQ(judge(policy, {"/stream", "localhost:8421", "http://localhost:8421"}, true), Verdict::kAllowed);
  // Through a tunnel the port is another one.
  EXPECT_EQ(judge(policy, {"/stream", "[::1]:9000", "http://[::1]:9000"}, true), Verdict::kAllowed);
  EXPECT_EQ(judge(policy, {"/", "LOCALHOST", ""}, true), Verdict::kAllowed);
}

TEST(RequestPolicy, NamesThatResolveToThisMachineAreNot) {
  const RequestPolicy policy;
  for (const char* host : {"evil.example:8421", "127.0.0.1.evil.example", "localhost.evil.example:8421", "",
                           "localhost:", "localhost:80x", "127.0.0.1:123456", "127.0.0.1@evil.example"}) {
    EXPECT_EQ(judge(policy, {"/", host, ""}, true), Verdict::kWrongHost) << host;
  }
}

TEST(RequestPolicy, OtherOriginsAreNot) {
  const RequestPolicy policy;
  for (const char* origin : {"http://evil.example", "https://127.0.0.1:8422", "http://127.0.0.1", "null",
                             "file://127.0.0.1:8421", "http://127.0.0.1:8421.evil.example"}) {
    EXPECT_EQ(judge(policy, {"/stream", "127.0.0.1:8421", origin}, true), Verdict::kWrongOrigin) << origin;
  }
}

TEST(RequestPolicy, TokenIsNeededWhereThereIsOne) {
  const RequestPolicy policy{false, "0123abcd"};
  EXPECT_EQ(judge(policy, {"/?token=0123abcd", "machine:8421", ""}, true), Verdict::kAllowed);
  EXPECT_EQ(judge(policy, {"/stream?x=1&token=0123abcd", "machine:8421", ""}, true), Verdict::kAllowed);
  for (const char* target : {"/", "/?token=", "/?token=0123abce", "/?token=0123abcd0", "/?token=0123abc", "/?token",
                             "/?atoken=0123abcd", "/?token=0123ABCD", "/#token=0123abcd", "/?&&token=x"}) {
    EXPECT_EQ(judge(policy, {target, "machine:8421", ""}, true), Verdict::kWrongToken) << target;
  }
  EXPECT_EQ(judge(policy, {"/app.js", "machine:8421", ""}, false), Verdict::kAllowed);
  EXPECT_EQ(judge(policy, {"/?token=0123abcd", "machine:8421", "http://other:8421"}, true), Verdict::kWrongOrigin);
}

TEST(RequestPolicy, PathsEndAtTheQuery) {
  EXPECT_EQ(path_of("/a?b?c"), "/a");
  EXPECT_EQ(path_of("/a"), "/a");
  EXPECT_EQ(path_of(""), "");
}

}  // namespace
}  // namespace ldso
