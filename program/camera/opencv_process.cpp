#include "camera/opencv_process.h"

#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>

namespace ldso {

void set_up_opencv() {
  cv::setNumThreads(1);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
}

}  // namespace ldso
