// pcalib.txt, the inverse response.

#include "fuzz_target.h"
#include "ldso/io/calibration_file.h"

LDSO_FUZZ_TARGET(pcalib_txt) {
  const auto response =
      ldso::fuzz::accepted([&] { return ldso::read_inverse_response(ldso::fuzz::scratch_file("pcalib.txt", input)); });
  if (!response) return;
  for (std::size_t i = 0; i < response->size(); ++i) {
    ldso::fuzz::expect(std::isfinite((*response)[i]), "an inverse response is finite");
    ldso::fuzz::expect(i == 0 || (*response)[i] > (*response)[i - 1], "an inverse response increases");
  }
  ldso::fuzz::expect(response->front() == 0 && response->back() >= 255 && response->back() < 256, "it is 0 to 255");
}
