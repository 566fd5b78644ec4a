// map.ply.

#include <algorithm>

#include "fuzz_target.h"
#include "ldso/io/pcd_file.h"
#include "ldso/io/ply_file.h"
#include "util/whole_file.h"

using namespace ldso;

LDSO_FUZZ_TARGET(point_cloud) {
  const auto points = fuzz::accepted([&] { return read_ply(fuzz::scratch_file("map.ply", input)); });
  if (!points) return;
  for (const PlyPoint& p : *points)
    fuzz::expect(fuzz::all_finite({p.x, p.y, p.z, p.idepth_stddev}), "all numbers of a point are finite");
  const auto path = fuzz::scratch_folder() / "again.ply";
  write_ply(path, *points);
  const std::vector<PlyPoint> again = read_ply(path);
  const auto same = [](const PlyPoint& a, const PlyPoint& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.intensity == b.intensity && a.color == b.color &&
           a.idepth_stddev == b.idepth_stddev;
  };
  fuzz::expect(std::equal(points->begin(), points->end(), again.begin(), again.end(), same),
               "a written cloud reads back as it was");
  write_pcd(fuzz::scratch_folder() / "again.pcd", *points);
}
