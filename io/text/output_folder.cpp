#include "io/text/output_folder.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr const char* kListName = ".ldso_files";
constexpr const char* kListTitle = "# Written by ldso, which overwrites and removes no other file here.\n";

/// An empty folder is nobody's.
bool is_there(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (!fs::exists(status)) return false;
  return !fs::is_directory(status) || !fs::is_empty(path, error);
}

}  // namespace

fs::path real_path(const fs::path& path) {
  const fs::path real = fs::weakly_canonical(fs::absolute(path));
  return real.has_filename() ? real : real.parent_path();
}

void create_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && fs::is_directory(folder, error)) return;
  throw Error(folder.string(), "the folder cannot be created" + (error ? " (" + error.message() + ")" : ""),
              "give a folder that can be written");
}

OutputFolder::OutputFolder(fs::path folder) : folder_(std::move(folder)) {
  create_folder(folder_);
  has_list_ = is_one(folder_);
  if (!has_list_) return;
  const std::string text = read_file(folder_ / kListName);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string name = text.substr(begin, end - begin);
    if (!name.empty() && name.front() != '#' && is_there(folder_ / name)) own_.insert(name);
    begin = end + 1;
  }
}

bool OutputFolder::is_one(const fs::path& folder) { return is_there(folder / kListName); }

void OutputFolder::adopt(const std::vector<std::string>& names) {
  std::copy_if(names.begin(), names.end(), std::inserter(own_, own_.end()),
               [&](const std::string& name) { return is_there(folder_ / name); });
  if (own_.empty()) return;  // Nothing of ldso: the folder is left as it is.
  write_list();
  has_list_ = true;
}

void OutputFolder::check(const std::vector<std::string>& names) {
  for (const std::string& name : names) refuse_foreign(name);
  write_list();
  has_list_ = true;
}

fs::path OutputFolder::file(const std::string& name) {
  if (!owns(name)) {
    refuse_foreign(name);
    own_.insert(name);
    try {
      write_list();
    } catch (const Error&) {
      own_.erase(name);  // A file that no list names would be a stranger's to the next run.
      throw;
    }
    has_list_ = true;
  }
  return folder_ / name;
}

void OutputFolder::remove(const std::string& name) {
  std::error_code error;
  const bool is_kept = name.ends_with('/') && is_there(folder_ / name);
  if (is_kept || own_.erase(name) == 0) return;
  fs::remove(folder_ / name, error);
  if (error) {
    throw Error((folder_ / name).string(), "cannot be removed (" + error.message() + ")",
                "remove it, or give another folder");
  }
  write_list();
}

void OutputFolder::refuse_foreign(const std::string& name) const {
  if (owns(name) || !is_there(folder_ / name)) return;
  throw Error((folder_ / name).string(), "is in the way: it was not written by ldso, which therefore does not touch it",
              "give another folder, or move it away");
}

void OutputFolder::write_list() const {
  std::string text = kListTitle;
  for (const std::string& name : own_) text.append(name).append("\n");
  write_file(folder_ / kListName, text);
}

void refuse_other_file(const fs::path& path, std::initializer_list<std::string_view> beginnings,
                       const std::string& kind) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return;
  const std::string content = read_file(path);
  const auto begins = [&](std::string_view beginning) { return content.starts_with(beginning); };
  if (content.empty() || std::any_of(beginnings.begin(), beginnings.end(), begins)) return;
  throw Error(path.string(), "is there already and is not " + kind + ", so that it is not overwritten",
              "name another file, or remove it");
}

}  // namespace ldso
