// A bag of ROS 2 is a folder: metadata.yaml names its files, which follow each other in time.

#include <algorithm>
#include <system_error>
#include <utility>

#include "io/bags/bag.h"
#include "io/bags/chunked_bag.h"
#include "io/text/yaml_node.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

class FolderBag final : public Bag {
 public:
  explicit FolderBag(const fs::path& folder) {
    std::string problem;
    for (const fs::path& file : files_of(folder)) {
      try {
        add(open_bag(file));
      } catch (const Error& error) {
        problem = error.what();
        warnings_.push_back("a file of the bag is left out: " + problem);
      }
    }
    if (files_.empty()) throw Error(folder.string(), "no file of the bag can be read", problem);
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }

  std::vector<BagMessage> messages(std::size_t topic) const override {
    std::vector<BagMessage> all;
    for (const auto& [file, number] : parts_.at(topic)) {
      for (BagMessage message : files_[file]->messages(number)) {
        message.file = file;
        all.push_back(message);
      }
    }
    sort_by_time(all);
    return all;
  }

  std::vector<std::uint8_t> read(const BagMessage& message, std::size_t most) const override {
    return files_.at(message.file)->read(message, most);
  }

 private:
  struct Part {
    std::uint32_t file = 0;
    std::size_t topic = 0;  ///< Of the file's.
  };

  /// The names are relative to the folder, in old bags with the folder's own name in front.
  static std::vector<fs::path> files_of(const fs::path& folder) {
    const YamlNode yaml = YamlNode::read(folder / "metadata.yaml", "metadata.yaml").at("rosbag2_bagfile_information");
    std::vector<fs::path> files;
    std::error_code error;
    for (const YamlNode& entry : yaml.at("relative_file_paths").elements()) {
      const std::string name = entry.text();
      const fs::path file = folder / name;
      files.push_back(fs::exists(file, error) ? file : folder / fs::path(name).filename());
    }
    return files;
  }

  void add(std::unique_ptr<Bag> bag) {
    const auto file = static_cast<std::uint32_t>(files_.size());
    for (std::size_t i = 0; i < bag->topics().size(); ++i) {
      const BagTopic& own = bag->topics()[i];
      const auto is_same = [&](const BagTopic& topic) {
        return topic.name == own.name && topic.type == own.type && topic.format == own.format;
      };
      const auto found = std::find_if(topics_.begin(), topics_.end(), is_same);
      const auto topic = static_cast<std::size_t>(found - topics_.begin());
      if (found == topics_.end()) {
        topics_.push_back({own.name, own.type, own.format, 0});
        parts_.emplace_back();
      }
      topics_[topic].count += own.count;
      parts_[topic].push_back({file, i});
    }
    warnings_.insert(warnings_.end(), bag->warnings().begin(), bag->warnings().end());
    files_.push_back(std::move(bag));
  }

  std::vector<std::unique_ptr<Bag>> files_;
  std::vector<BagTopic> topics_;
  std::vector<std::vector<Part>> parts_;  ///< Of each topic.
  std::vector<std::string> warnings_;
};

}  // namespace

std::unique_ptr<Bag> open_bag_folder(const fs::path& folder) { return std::make_unique<FolderBag>(folder); }

}  // namespace ldso
