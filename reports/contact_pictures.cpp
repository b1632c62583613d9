#include "reports/contact_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/units.h"
#include "render/camera.h"
#include "render/image_io.h"
#include "render/lettering.h"
#include "render/ray/ray_scene.h"
#include "render/ray/still.h"
#include "reports/part_view.h"
#include "reports/pictures.h"

namespace swarf::reports {
namespace {

constexpr double kContactView = 0.45;  // rad, vertical
constexpr int kContactSamples = 12;    // a pixel: these are looked at, not printed
constexpr double kLeastView_mm = 25.0;
constexpr render::Rgb kRingColour{0.85F, 0.05F, 0.04F};

struct Found {
  std::string pair;  ///< told once
  double t_s = 0.0;
  ContactPicture picture;
};

std::string where(const sim::Result& result, int element, double t_s) {
  return fmt::format("line {}, {:.3f} s", result.main.path.elements.line(static_cast<size_t>(element)), t_s);
}

void add_machine_contacts(const sim::Result& result, std::vector<Found>& found) {
  if (!result.main.contacts) return;
  const sim::MachineContacts& contacts = *result.main.contacts;
  for (const collision::PairFindings& pair : contacts.findings.pairs) {
    if (pair.contacts.empty() || contacts.with_stock(pair)) continue;
    const collision::ContactEvent& event = pair.contacts.front();
    const std::string names = contacts.bodies[pair.a].name + " and " + contacts.bodies[pair.b].name;
    found.push_back({names,
                     event.first.time_s,
                     {fmt::format("First contact of {}: {}.", names,
                                  where(result, event.first_element, event.first.time_s)),
                      event.first.cycle + (event.first.share > 0.0 ? 1 : 0), event.point_a}});
  }
  if (!contacts.as_cut) return;
  for (const sim::StockEvent& event : contacts.as_cut->events) {
    if (event.verdict != sim::StockVerdict::kContact) continue;
    const std::string name =
        contacts.bodies[contacts.beside_stock(contacts.findings.pairs[event.suspect.pair])].name;
    found.push_back({name + " and stock",
                     event.first.time_s,
                     {fmt::format("{} in the stock, {:.3f} mm deep where it was looked at: {}.", name,
                                  event.depth_mm, where(result, event.first.element, event.first.time_s)),
                      event.first.cycle + 1, event.place_M}});
  }
}

void add_tool_contacts(const sim::Job& job, const sim::Result& result, std::vector<Found>& found) {
  const MachineView view(job);
  const motion::Cycles& cycles = *result.main.cycles;
  motion::CycleReader reader(cycles);
  for (const sim::ContactEvent& event : result.clearance.events) {
    const auto cycle = static_cast<size_t>(std::lround(event.deepest.t_s / cycles.period_s()));
    const size_t k = std::min(cycle, cycles.size() - 1);
    const std::string name =
        job.scene.tools.size() > 1
            ? fmt::format("{} of {}", event.part,
                          cutter::call_name(job.scene.tools[static_cast<size_t>(event.tool)]))
            : event.part;
    found.push_back({name + " in the material",
                     event.deepest.t_s,
                     {fmt::format("{} in the material, {:.3f} mm deep: {}.", name, event.depth_mm,
                                  where(result, event.deepest.element, event.deepest.t_s)),
                      k, view.work_pose(reader.at(k).q) * event.deepest_W}});
  }
}

/// From the place to the eye, those that are tried first are kept where others show no more.
std::vector<Vec3> views() {
  std::vector<Vec3> list;
  for (const double up_deg : {35.0, 15.0, 60.0})
    for (const double round_deg : {-125.0, -55.0, -90.0, 180.0, 0.0, -145.0, -35.0, 90.0, 125.0, 55.0}) {
      const double up = rad_from_deg(up_deg), round = rad_from_deg(round_deg);
      list.emplace_back(std::cos(up) * std::cos(round), std::cos(up) * std::sin(round), std::sin(up));
    }
  return list;
}

/// Places about the contact that its picture should show.
std::vector<Vec3> neighbours(const Vec3& place, double view_mm) {
  std::vector<Vec3> list;
  for (const double share : {0.02, 0.08, 0.2})
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const Vec3 way(x, y, z);
          if (way.norm() > 0.0) list.push_back(place + share * view_mm * way.normalized());
        }
  return list;
}

Vec3 best_view(const render::DrawList& list, const Vec3& place, double view_mm) {
  const render::RayScene scene(list, 0.0);
  const std::vector<Vec3> places = neighbours(place, view_mm);
  Vec3 best = Vec3::UnitZ();
  int most = -1;
  for (const Vec3& view : views()) {
    const render::Vec3f direction = view.cast<float>();
    const auto seen = static_cast<int>(std::count_if(places.begin(), places.end(), [&](const Vec3& at) {
      return !scene.occluded(at.cast<float>(), direction);
    }));
    if (seen > most) {
      most = seen;
      best = view;
    }
  }
  return best;
}

/// Half way to the eye, where nothing hides it.
render::DrawLine ring_about(const Vec3& place, const render::Camera& camera, double radius) {
  constexpr int kCorners = 48;
  const Vec3 to_eye = camera.eye - place, out = to_eye.normalized();
  const Vec3 x =
      (std::abs(out.z()) < 0.9 ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitX())).cross(out).normalized();
  const Vec3 y = out.cross(x), centre = place + 0.5 * to_eye;
  render::DrawLine ring;
  for (int i = 0; i <= kCorners; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / kCorners;
    ring.points.push_back(centre + 0.5 * radius * (std::cos(turn) * x + std::sin(turn) * y));
  }
  ring.colour = kRingColour;
  ring.width_px = 3.0F;
  ring.name = "contact";
  return ring;
}

}  // namespace

std::vector<ContactPicture> contact_pictures(const sim::Job& job, const sim::Result& result) {
  std::vector<Found> found;
  add_machine_contacts(result, found);
  add_tool_contacts(job, result, found);
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.t_s < b.t_s; });
  std::vector<ContactPicture> pictures;
  std::vector<std::string> told;
  for (const Found& one : found) {
    if (pictures.size() == kContactPicturesMost) break;
    if (std::find(told.begin(), told.end(), one.pair) != told.end()) continue;
    told.push_back(one.pair);
    pictures.push_back(one.picture);
  }
  return pictures;
}

namespace {

render::Image contact_image(const FinishedRun& run, const ContactPicture& picture) {
  motion::CycleReader reader(run.cycles);
  const motion::Cycle cycle = reader.at(std::min(picture.cycle, run.cycles.size() - 1));
  const auto tool = static_cast<size_t>(std::max<int>(0, cycle.sample.tool));
  const TriMesh stock = stock_at(run, cycle);
  render::DrawList list;
  const MachineView view(run.job);
  list.items = view.items(cycle.q, tool, &stock);
  const double view_mm = std::max(kLeastView_mm, 2.5 * run.job.scene.tools[tool].diameter_mm);
  const Vec3 half = Vec3::Constant(view_mm);
  const auto& size = run.job.scene.stills.size;
  const Vec3 direction = best_view(list, picture.place_M, view_mm);
  list.camera = render::look_at_box({picture.place_M - half, picture.place_M + half}, -direction,
                                    kContactView, static_cast<double>(size[0]) / size[1]);
  list.lines.push_back(ring_about(picture.place_M, list.camera, 0.25 * view_mm));
  render::StillOptions options;
  options.width = size[0];
  options.height = size[1];
  options.samples_per_pixel = std::min(kContactSamples, run.job.scene.stills.samples);
  options.strip_strength = 0.0;
  options.floor = false;
  return render::render_still(list, options);
}

}  // namespace

void make_contact_picture(const FinishedRun& run, const ContactPicture& picture, const std::string& path) {
  render::save_png(contact_image(run, picture), path);
}

void make_finding_picture(const FinishedRun& run, const KeptFindings& kept, int number,
                          const std::string& path) {
  const auto named = std::find(kept.numbers.begin(), kept.numbers.end(), number);
  if (named == kept.numbers.end()) {
    const int many = kept.faults();
    throw InputError("unknown-finding", {fmt::format("--finding {}", number)},
                     many == 0 ? "this run has no finding" : fmt::format("this run has {} findings", many),
                     many == 0 ? "leave out --finding" : fmt::format("write a number from 1 to {}", many));
  }
  const sim::Finding& finding = kept.list[static_cast<size_t>(named - kept.numbers.begin())];
  motion::CycleReader reader(run.cycles);
  const auto k = static_cast<size_t>(std::max(0L, std::lround(finding.t_s / run.cycles.period_s())));
  const size_t cycle = std::min(k, run.cycles.size() - 1);
  const motion::Cycle& at = reader.at(cycle);
  const Vec3 place = MachineView(run.job).work_pose(at.q) * at.sample.pose.tip_W;
  render::Image image = contact_image(run, {finding.text, cycle, place});
  std::vector<std::string> lines{fmt::format("finding {}: {}", number, finding.text)};
  if (finding.where.line > 0)
    lines.push_back(fmt::format("line {}   {:.3f} s   {}", finding.where.line, finding.t_s, finding.block));
  render::draw_caption(image, lines);
  render::save_png(image, path);
}

namespace {

/// What lies so near to a place that a picture of it may show it.
TriMesh neighbourhood(const TriMesh& mesh, const Vec3& place, double reach_mm) {
  TriMesh near = mesh;
  near.triangles.clear();
  for (const auto& t : mesh.triangles) {
    const bool inside = std::any_of(t.begin(), t.end(), [&](uint32_t v) {
      const auto& p = mesh.positions[v];
      return (Vec3(p[0], p[1], p[2]) - place).norm() < reach_mm;
    });
    if (inside) near.triangles.push_back(t);
  }
  return near;
}

}  // namespace

void make_place_picture(const TriMesh& coloured, const Vec3& place, double width_mm,
                        const std::string& path) {
  constexpr double kShown = 3.0;  // widths: beyond, nothing is in the picture
  const TriMesh near = neighbourhood(coloured, place, kShown * width_mm);
  render::DrawList list;
  list.items.push_back({&near, Pose::Identity(), {{1.0F, 1.0F, 1.0F}, 0.0F, 0.7F}});
  const Vec3 half = Vec3::Constant(0.5 * width_mm);
  render::StillOptions options;
  options.width = 640;
  options.height = 400;
  options.samples_per_pixel = kContactSamples;
  options.strip_strength = 0.0;  // reflections would tint the colours
  options.floor = false;
  list.camera = render::look_at_box({place - half, place + half}, -best_view(list, place, width_mm),
                                    kContactView, double(options.width) / options.height);
  list.lines.push_back(ring_about(place, list.camera, 0.2 * width_mm));
  render::save_png(render::render_still(list, options), path);
}

}  // namespace swarf::reports
