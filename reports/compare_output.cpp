#include "reports/compare_output.h"

#include "mesh/mesh_io.h"
#include "mesh/mesh_ops.h"
#include "render/camera.h"
#include "render/figures/colour.h"
#include "render/image_io.h"
#include "render/lettering.h"
#include "render/ray/still.h"
#include "reports/pending_folder.h"
#include "reports/pictures.h"

namespace swarf::reports {

void write_compare(const std::string& target, TriMesh stock, double scale_um, const std::string& metrics) {
  PendingFolder folder(target);
  render::colour_by_deviation(stock, scale_um);
  mesh::save_mesh(folder.file(kCompareMark), stock);
  render::save_png(deviation_picture(stock, scale_um, "iso", {}), folder.file("deviation.png"));
  write_text(folder.file("metrics.json"), metrics);
  folder.move_into_place();
}

}  // namespace swarf::reports
