#include "sim/job/still_keys.h"

#include "sim/job/movie_keys.h"

namespace swarf::sim {
namespace {

StillShot read_still_shot(ConfigTable& table) {
  StillShot shot;
  shot.where = table.where();
  shot.kind = table.choice("kind", kStillKinds, shot.kind);
  shot.camera = read_camera(table, shot.camera);
  shot.section = read_section(table);
  return shot;
}

}  // namespace

StillSettings read_stills(ConfigTable table) {
  StillSettings stills;
  stills.size = read_picture_size(table);
  stills.kinds = table.choices("kinds", kStillKinds, kStillKinds);
  stills.samples = table.integer("samples", 1, 4096, stills.samples);
  if (table.has("labels")) stills.labels = table.boolean("labels");
  stills.transparent = table.boolean("transparent", stills.transparent);
  if (!table.has("shot")) return stills;
  for (ConfigTable& shot : table.tables("shot")) stills.shots.push_back(read_still_shot(shot));
  return stills;
}

void require_still_shots(const StillSettings& stills, const Box& stock_W, bool has_design) {
  for (const StillShot& shot : stills.shots) {
    if (shot.kind == "deviation" && !has_design)
      throw InputError("nothing-measured", shot.where, "there is no design that the part deviates from",
                       "name one in [design], or write kind = \"part\"");
    if (shot.section) require_section(*shot.section, shot.where, stock_W);
  }
}

}  // namespace swarf::sim
