#include "viewer/server/request_policy.h"

#include <algorithm>
#include <cctype>

namespace ldso {
namespace {

/// Without an early end, so that the time tells nothing of how much was right.
bool is_same_secret(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char other = i < b.size() ? b[i] : '\0';
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(other);
  }
  return difference == 0;
}

/// The value of `name` in the query of a target; empty if there is none.
std::string_view query_value(std::string_view target, std::string_view name) {
  const std::size_t mark = target.find('?');
  std::string_view query = mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view pair = query.substr(0, end);
    if (pair.substr(0, name.size()) == name && pair.substr(name.size(), 1) == "=") return pair.substr(name.size() + 1);
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return {};
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Whether the page that asks was served under the name under which it asks.
bool is_own_origin(std::string_view origin, std::string_view host) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.substr(0, scheme.size()) == scheme) return lower(origin.substr(scheme.size())) == lower(host);
  }
  return false;  // "null", or no address at all.
}

}  // namespace

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

bool is_loopback_host(std::string_view host) {
  for (const std::string_view name : {"127.0.0.1", "localhost", "[::1]"}) {
    if (lower(host.substr(0, name.size())) != name) continue;
    const std::string_view rest = host.substr(name.size());
    if (rest.empty() || (rest[0] == ':' && is_port(rest.substr(1)))) return true;
  }
  return false;
}

Verdict judge(const RequestPolicy& policy, const RequestFacts& facts, bool needs_token) {
  if (facts.host.empty() || (policy.loopback_only && !is_loopback_host(facts.host))) return Verdict::kWrongHost;
  if (!facts.origin.empty() && !is_own_origin(facts.origin, facts.host)) return Verdict::kWrongOrigin;
  if (needs_token && !policy.token.empty() && !is_same_secret(policy.token, query_value(facts.target, "token"))) {
    return Verdict::kWrongToken;
  }
  return Verdict::kAllowed;
}

}  // namespace ldso
