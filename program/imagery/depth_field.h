#pragma once
// A guess of the inverse depth at every pixel from those of a few points: near a point its own, farther away the mean
// of more and more of them. Where a rolling shutter shows a pixel depends on it a little.

#include <Eigen/Core>
#include <vector>

namespace ldso {

class DepthField {
 public:
  DepthField(int width, int height);

  /// A point at `pixel`; outside of the image it is left out.
  void add(const Eigen::Vector2d& pixel, double idepth);

  /// After the last point. Without any, everything is infinitely far away.
  void spread();

  /// Between the centres of the cells linear.
  double at(const Eigen::Vector2d& pixel) const;

 private:
  /// Sums, and after spread() means, over square cells.
  struct Level {
    int columns = 0, rows = 0;
    std::vector<double> sum, weight;

    /// Bilinear; (0, 0) is the centre of the first cell. Beyond the outermost centres it is what they are.
    double interpolated(double x, double y) const;
  };

  int width_, height_;
  std::vector<Level> levels_;  ///< From fine to one cell.
};

}  // namespace ldso
