// --view=ADDRESS:PORT, and what decides whether a request is answered. Three lines: address or Host, Origin, target.

#include "viewer/server/listen_address.h"

#include <algorithm>

#include "fuzz_target.h"
#include "viewer/server/request_policy.h"

using namespace ldso;

LDSO_FUZZ_TARGET(listen_address) {
  const auto [first, rest] = fuzz::split_line(input);
  const std::string_view host = first;  // What lambdas can capture.
  const auto [origin, target] = fuzz::split_line(rest);
  if (host.find('\0') != std::string_view::npos) return;  // No command line and no header holds one.
  const auto address = fuzz::accepted([&] { return parse_listen_address(std::string(host)); });
  if (address)
    fuzz::expect(viewer_url(address->host, address->port, "").starts_with("http://"), "an address has a URL");
  const RequestFacts facts{target, host, origin};
  const Verdict verdict = judge({true, "c0ffee"}, facts, true);
  if (verdict != Verdict::kAllowed) return;
  fuzz::expect(is_loopback_host(host), "only names of this machine are answered");
  fuzz::expect(target.find("token=c0ffee") != std::string_view::npos, "only with the token");
  fuzz::expect(origin.empty() || origin.size() > host.size(), "only pages of our own");
}
