#include "util/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "ldso/error.h"
#include "util/out_of_memory.h"

namespace ldso {
namespace {

/// A file may be larger than the memory, or claim to be (a sparse one).
std::string zeros(std::size_t count, const std::filesystem::path& path) {
  try {
    return std::string(count, '\0');
  } catch (const std::exception&) {  // Also std::length_error: more than there are addresses for.
    throw OutOfMemory("reading " + path.string() + ", " + std::to_string(count >> 20) + " MB");
  }
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw Error(path.string(), "is a folder", "a file is expected here");
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream) throw Error(path.string(), "cannot be opened", "check that the file exists and may be read");
  const std::streamoff size = stream.tellg();
  std::string content = zeros(static_cast<std::size_t>(size > 0 ? size : 0), path);
  stream.seekg(0);
  stream.read(content.data(), static_cast<std::streamsize>(content.size()));
  if (!stream) throw Error(path.string(), "cannot be read to its end", "check the disk");
  return content;
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  std::filesystem::path partial = path;
  // Two processes may write the same file at once (runners of one experiment): each its own, the last one stays.
  partial += ".";
  partial += std::to_string(getpid()).append(".partial");
  std::error_code error;
  {
    errno = 0;  // Streams do not say why they fail, but leave what the system said.
    std::ofstream stream(partial, std::ios::binary | std::ios::trunc);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream) {
      const std::string reason = errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : "";
      std::filesystem::remove(partial, error);
      throw Error(path.string(), "cannot be written" + reason,
                  "check that the folder exists, may be written and has room");
    }
  }
  std::filesystem::rename(partial, path, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw Error(path.string(), "cannot be written (" + error.message() + ")", "check what is in its place");
  }
}

}  // namespace ldso
