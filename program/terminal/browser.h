#pragma once
// A page served by this program, and the browser that shows it.

#include <string>

namespace ldso {

/// Prints where the page is and, if there is a desktop, opens it.
void announce_page(const std::string& url);

/// Until Ctrl-C.
void serve_until_interrupted(const std::string& url);

}  // namespace ldso
