#pragma once

// Idea: a folder that results are written to may hold files of its user. It keeps a list of the files that ldso wrote
// there (.ldso_files), and no other file is ever overwritten or removed.

#include <filesystem>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace ldso {

/// Names are relative to the folder. One that ends in "/" stands for a folder with everything in it.
class OutputFolder {
 public:
  /// Creates the folder. What is listed but not there any more is nobody's. Throws Error if the folder cannot be
  /// created or its list not be read.
  explicit OutputFolder(std::filesystem::path folder);

  const std::filesystem::path& path() const { return folder_; }
  bool owns(const std::string& name) const { return own_.contains(name); }
  /// Whether it has a list. Versions of ldso that kept none left other marks; see adopt().
  bool has_list() const { return has_list_; }

  /// Whether a folder has a list.
  static bool is_one(const std::filesystem::path& folder);

  /// Takes what there is of these names for files of ldso: those of a version that kept no list.
  void adopt(const std::vector<std::string>& names);

  /// Better before a long run than after it: throws Error if one of the names is there but was not written by ldso, or
  /// if the folder cannot be written.
  void check(const std::vector<std::string>& names);

  /// The path of a file that is to be written now. Throws Error if there is one that ldso did not write.
  std::filesystem::path file(const std::string& name);

  /// Removes a file if ldso wrote it; a folder if it is empty as well.
  void remove(const std::string& name);

 private:
  void refuse_foreign(const std::string& name) const;
  void write_list() const;

  std::filesystem::path folder_;
  std::set<std::string> own_;
  bool has_list_ = false;
};

/// Absolute and without links and a last "/"; it need not exist.
std::filesystem::path real_path(const std::filesystem::path& path);

/// Creates a folder with those around it. Throws Error if that is impossible.
void create_folder(const std::filesystem::path& folder);

/// A file that a user names is overwritten only if it looks like one of the same kind: throws Error if `path` is there
/// and begins with none of `beginnings`. `kind`: what is about to be written, "a vocabulary".
void refuse_other_file(const std::filesystem::path& path, std::initializer_list<std::string_view> beginnings,
                       const std::string& kind);

}  // namespace ldso
