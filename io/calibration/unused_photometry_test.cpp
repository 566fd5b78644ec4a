#include "io/calibration/unused_photometry.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"
#include "ldso/io/dataset.h"

namespace ldso {
namespace {

std::vector<std::string> warnings_with(const std::string& name) {
  const TemporaryFolder folder;
  make_tum_mono(folder.path(), 2);
  if (!name.empty()) write_text(folder / name, "x");
  return open_dataset(folder.path())->warnings();
}

TEST(UnusedPhotometry, OfAnotherNameIsSaid) {
  for (const char* name : {"vignetteSmoothed.png", "vignette.jpg", "Vignette.tif", "pcalib.csv", "response.txt"}) {
    const std::vector<std::string> warnings = warnings_with(name);
    ASSERT_EQ(warnings.size(), 1U) << name;
    EXPECT_NE(warnings[0].find(std::string(name) + ": this "), std::string::npos) << warnings[0];
  }
}

TEST(UnusedPhotometry, IsNotSoughtInOtherFiles) {
  EXPECT_TRUE(warnings_with("").empty());
  EXPECT_TRUE(warnings_with("notes.txt").empty());
}

TEST(UnusedPhotometry, BesideWhatIsUsedIsNoWarning) {
  const TemporaryFolder folder;
  write_text(folder / "vignetteSmoothed.png", "x");
  PhotometricCalibration photometric;
  photometric.vignette = Image<float>(2, 2);
  std::vector<std::string> warnings;
  warn_about_unused_photometry(folder.path(), photometric, warnings);
  EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace ldso
