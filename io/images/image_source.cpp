#include "io/images/image_source.h"

#include <zip.h>

#include <system_error>
#include <utility>

#include "io/images/image_file.h"
#include "io/images/image_header.h"
#include "io/images/image_names.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// That are unpacked at once.
constexpr std::size_t kPartBytes = 1 << 16;

/// The vignette lies beside the images of a plain folder; names with a dot in front are leftovers of other programs.
bool is_frame_name(const fs::path& path) {
  const std::string name = path.filename().string();
  return has_image_extension(path) && name.front() != '.' && path.stem() != "vignette" &&
         path.stem() != "vignetteSmoothed";
}

class ImageFolder final : public ImageSource {
 public:
  explicit ImageFolder(fs::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    if (!fs::is_directory(folder_, error)) throw Error(folder_.string(), "is not a folder", "check the path");
  }

  std::vector<std::string> names() const override {
    std::vector<std::string> result;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      if (!entry.is_directory() && is_frame_name(entry.path())) result.push_back(entry.path().filename().string());
    }
    sort_image_names(result);
    return result;
  }

  std::vector<std::uint8_t> read(const std::string& name) const override {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(folder_ / name, error);
    if (!error && size > kMostImageBytes) throw Error(describe(name), "is larger than 512 MB", "make it smaller");
    return read_bytes(folder_ / name);
  }
  std::string describe(const std::string& name) const override { return (folder_ / name).string(); }

 private:
  fs::path folder_;
};

class ImageZip final : public ImageSource {
 public:
  explicit ImageZip(fs::path path) : path_(std::move(path)) {
    int code = 0;
    archive_.reset(zip_open(path_.c_str(), ZIP_RDONLY, &code));
    if (archive_) {
      refuse_encrypted();
      return;
    }
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    const std::string reason = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw Error(path_.string(), "cannot be opened as a zip archive (" + reason + ")",
                "copy it again, or unpack it into a folder images/");
  }

  std::vector<std::string> names() const override {
    std::vector<std::string> result;
    const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
    for (zip_int64_t i = 0; i < count; ++i) {
      const char* name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
      if (name != nullptr && is_frame_name(name)) result.emplace_back(name);
    }
    sort_image_names(result);
    return result;
  }

  std::vector<std::uint8_t> read(const std::string& name) const override {
    const std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file(zip_fopen(archive_.get(), name.c_str(), 0),
                                                                  &zip_fclose);
    if (!file) fail(name, zip_strerror(archive_.get()));
    // The archive may claim any size: memory is taken for what really comes out of it.
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint8_t> part(kPartBytes);
    while (const zip_int64_t count = zip_fread(file.get(), part.data(), part.size())) {
      if (count < 0) fail(name, zip_file_strerror(file.get()));
      bytes.insert(bytes.end(), part.begin(), part.begin() + count);
      if (bytes.size() > kMostImageBytes) fail(name, "it is larger than 512 MB");
    }
    return bytes;
  }

  std::string describe(const std::string& name) const override { return path_.string() + ":" + name; }

 private:
  void refuse_encrypted() const {
    const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
    for (zip_int64_t i = 0; i < count; ++i) {
      zip_stat_t entry;
      zip_stat_init(&entry);
      if (zip_stat_index(archive_.get(), static_cast<zip_uint64_t>(i), 0, &entry) != 0) continue;
      if ((entry.valid & ZIP_STAT_ENCRYPTION_METHOD) == 0 || entry.encryption_method == ZIP_EM_NONE) continue;
      throw Error(path_.string(), "the archive is encrypted", "unpack it with its password into a folder images/");
    }
  }

  [[noreturn]] void fail(const std::string& name, const std::string& reason) const {
    throw Error(describe(name), "cannot be unpacked (" + reason + ")", "copy the archive again");
  }

  struct Discard {
    void operator()(zip_t* archive) const { zip_discard(archive); }
  };
  fs::path path_;
  std::unique_ptr<zip_t, Discard> archive_;
};

}  // namespace

std::unique_ptr<ImageSource> open_image_folder(const fs::path& folder) { return std::make_unique<ImageFolder>(folder); }

std::unique_ptr<ImageSource> open_image_zip(const fs::path& archive) { return std::make_unique<ImageZip>(archive); }

}  // namespace ldso
