#include "viewer/server/random_id.h"

#include <sys/random.h>

#include <cerrno>
#include <cstring>

#include "ldso/error.h"
#include "util/format_text.h"

namespace ldso {

std::uint64_t random_id() {
  std::uint64_t id = 0;
  if (getrandom(&id, sizeof(id), 0) != static_cast<ssize_t>(sizeof(id))) {
    throw Error("random numbers of the system", std::strerror(errno), "");
  }
  return id;
}

std::string make_token() {
  return format_text("%016llx%016llx", static_cast<unsigned long long>(random_id()),
                     static_cast<unsigned long long>(random_id()));
}

}  // namespace ldso
