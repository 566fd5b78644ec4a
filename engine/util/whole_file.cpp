#include "util/whole_file.h"

#include <unistd.h>

#include <fstream>
#include <system_error>

#include "ldso/error.h"

namespace ldso {

std::string read_file(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw Error(path.string(), "is a folder", "a file is expected here");
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream) throw Error(path.string(), "cannot be opened", "check that the file exists and may be read");
  const std::streamoff size = stream.tellg();
  std::string content(static_cast<std::size_t>(size > 0 ? size : 0), '\0');
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
    std::ofstream stream(partial, std::ios::binary | std::ios::trunc);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream) {
      std::filesystem::remove(partial, error);
      throw Error(path.string(), "cannot be written", "check that the folder exists, may be written and has room");
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
