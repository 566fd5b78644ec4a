#pragma once
// A page served by this program, and the browser that shows it.

#include <string>

#include "viewer/server.h"

namespace ldso {

/// For `--view=ADDRESS:PORT`: other addresses than those of this machine alone get a token. Throws Error.
ServerOptions server_options(const std::string& address);

/// Prints where the page is and, if there is a desktop, opens it.
void announce_page(const std::string& url);

/// Until Ctrl-C.
void serve_until_interrupted(const std::string& url);

}  // namespace ldso
