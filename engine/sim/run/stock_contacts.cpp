#include "sim/run/stock_contacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "base/check.h"
#include "base/hash.h"

namespace swarf::sim {
namespace {

using collision::AxisValues;

constexpr size_t kNever = std::numeric_limits<size_t>::max();
constexpr uint64_t kWaysAtOnce = 1024;

void add_shape(Hash& hash, const collision::Body& body) {
  const auto add = [&](const Vec3& v) {
    for (int i = 0; i < 3; ++i) hash.add(v[i]);
  };
  for (const collision::Triangle& triangle : body.triangles)
    for (const Vec3& corner : triangle) add(corner);
  for (const collision::RevolvedSolid& solid : body.solids) {
    add(solid.foot);
    add(solid.axis);
    for (const Vec2& corner : solid.corners) {
      hash.add(corner.x());
      hash.add(corner.y());
    }
  }
}

}  // namespace

StockContactCheck::StockContactCheck(const Job& job, const MachineContacts* contacts,
                                     const motion::Cycles& cycles, const CutSweeps& sweeps)
    : contacts_(contacts), sweeps_(sweeps), cycles_(cycles), reader_(cycles), due_(kNever) {
  if (contacts == nullptr || contacts->suspects.empty()) return;
  if (job.scene.stock.auto_box) return;  // of an assumed block no contact is judged
  body_.emplace(job.machine, job.scene.stock.body_W().mesh_around());
  seen_mm_ = collision::StockBody::kSeenVoxels * job.scene.stock.voxel_mm + sweeps.error_bound_mm;
  for (const StockSuspect& of : contacts->suspects) {
    Suspect suspect;
    suspect.of = of;
    suspect.next = of.cycles.first;
    suspects_.push_back(suspect);
  }
  set_due(suspects_.front());
  due_ = suspects_.front().due;
}

/// Sweeps whose end the tool has reached in this cycle.
size_t StockContactCheck::sweeps_before(uint64_t cycle) const {
  const motion::Cycle& at = reader_.at(cycle);
  size_t low = 0, high = sweeps_.size();
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (is_done(sweeps_.source(middle), at)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/// Those and the one that may be under way at the end of the way from this cycle.
size_t StockContactCheck::sweeps_behind(uint64_t way) const {
  return std::min(sweeps_before(std::min(way + 1, uint64_t{cycles_.size()} - 1)) + 1, sweeps_.size());
}

const collision::Body& StockContactCheck::body_of(const Suspect& suspect) const {
  return contacts_->shapes.at(contacts_->beside_stock(contacts_->findings.pairs[suspect.of.pair]));
}

uint64_t StockContactCheck::last_way(const Suspect& suspect) const {
  const collision::CycleSpan& cycles = suspect.of.cycles;
  return std::max(cycles.first + 1, cycles.last) - 1;
}

void StockContactCheck::set_due(Suspect& suspect) const {
  suspect.due = suspect.blocked ? sweeps_behind(suspect.next) : sweeps_before(suspect.next);
}

/// The places of the axes in these cycles; of a single one twice, where they stand.
std::vector<AxisValues> StockContactCheck::places(uint64_t first, uint64_t last) const {
  std::vector<AxisValues> places;
  for (uint64_t k = first; k <= last; ++k) places.push_back(reader_.at(k).q);
  if (places.size() == 1) places.push_back(places.front());
  return places;
}

void StockContactCheck::pass_clear_ways(Suspect& suspect) const {
  const collision::CycleSpan& cycles = suspect.of.cycles;
  while (suspect.next <= last_way(suspect)) {
    const uint64_t end = std::min(suspect.next + kWaysAtOnce, cycles.last);
    const std::vector<AxisValues> way = places(suspect.next, end);
    const size_t clear = body_->clear_ways(body_of(suspect), way, sweeps_.error_bound_mm);
    suspect.next += clear;
    if (clear + 1 < way.size()) return;
  }
  suspect.done = true;
  suspect.verdict = StockVerdict::kClear;
}

/// Of a contact: where the body first touches what is left now, which is no later than it touched anything.
/// Ways before the first one that is not clear are.
void StockContactCheck::find_first(Suspect& suspect) const {
  for (uint64_t from = suspect.not_clear; from <= suspect.next; from += kWaysAtOnce) {
    const uint64_t to = std::min({from + kWaysAtOnce, suspect.next + 1, suspect.of.cycles.last});
    const std::optional<collision::StockTouch> touch = body_->first_touch(body_of(suspect), places(from, to));
    if (!touch) continue;
    suspect.cycle = from + touch->way;
    suspect.share = touch->at.t_touch;
    suspect.first_M = touch->at.point_a;
    return;
  }
}

/// Against the stock behind the sweeps of the way; then on to the next one that is to be looked at.
void StockContactCheck::judge_way(Suspect& suspect) const {
  const std::vector<AxisValues> way =
      places(suspect.next, std::min(suspect.next + 1, suspect.of.cycles.last));
  collision::AxisSegment segment;
  segment.q0 = way.front();
  segment.q1 = way.back();
  const collision::StockAnswer answer = body_->over(body_of(suspect), segment);
  if (answer.outcome == collision::StockOutcome::kContact && suspect.verdict != StockVerdict::kContact) {
    suspect.verdict = StockVerdict::kContact;
    suspect.cycle = suspect.next;
    suspect.first_M = answer.point_M;
    find_first(suspect);
  }
  if (answer.depth_mm > suspect.depth_mm) {
    suspect.depth_mm = answer.depth_mm;
    suspect.place_M = answer.point_M;
  }
  const uint64_t before = suspect.next, left = last_way(suspect) - suspect.not_clear;
  while (suspect.next == before && suspect.looked_at < kDeeper)
    suspect.next = suspect.not_clear + ++suspect.looked_at * left / kDeeper;
  suspect.done = suspect.next == before;
}

void StockContactCheck::look_at(Suspect& suspect, size_t sweeps) const {
  if (!suspect.blocked) {
    SWARF_CHECK(suspect.due >= sweeps, "ways are looked at before their material is cut");
    pass_clear_ways(suspect);
    if (suspect.done) return;
    set_due(suspect);
    if (suspect.due > sweeps) return;
    suspect.blocked = true;
    suspect.not_clear = suspect.cycle = suspect.next;
    set_due(suspect);
  }
  while (!suspect.done && suspect.due <= sweeps) {
    judge_way(suspect);
    set_due(suspect);
  }
}

void StockContactCheck::look(const stock::Stock& stock) {
  SWARF_CHECK(looks_ < kLooksMost, "nothing is due after the last look");
  const size_t sweeps = due_;
  body_->refresh(stock);
  ++looks_;
  due_ = kNever;
  for (Suspect& suspect : suspects_) {
    if (suspect.done) continue;
    if (suspect.due == 0) set_due(suspect);
    // Those behind begin later still.
    if (!suspect.blocked && suspect.next == suspect.of.cycles.first && suspect.due > due_) break;
    look_at(suspect, sweeps);
    if (!suspect.done) due_ = std::min(due_, suspect.due);
  }
  if (looks_ == kLooksMost) close();
}

/// What the last look does not clear stays as it is.
void StockContactCheck::close() {
  for (Suspect& suspect : suspects_) {
    if (suspect.done) continue;
    if (!suspect.blocked) pass_clear_ways(suspect);
    if (suspect.done) continue;
    unseen_ = suspect.done = true;
    if (!suspect.blocked) suspect.cycle = suspect.next;
  }
  due_ = kNever;
}

/// Of what is looked at: bodies, ways, machine.
uint64_t StockContactCheck::identity() const {
  Hash hash;
  for (const Suspect& suspect : suspects_) {
    const StockSuspect& of = suspect.of;
    for (const uint64_t word : {uint64_t{of.pair}, of.cycles.first, of.cycles.last}) hash.add(word);
    for (const uint64_t cycle : {of.cycles.first, of.cycles.last})
      for (const double q : reader_.at(cycle).q) hash.add(q);
  }
  for (const auto& [index, body] : contacts_->shapes) add_shape(hash, body);
  if (body_) add_shape(hash, body_->raw());
  return hash.value();
}

std::string StockContactCheck::text() const {
  if (suspects_.empty()) return "0";
  std::string text = fmt::format("{} {} {} {} {}", suspects_.size(), identity(), looks_, int{unseen_}, due_);
  for (const Suspect& s : suspects_) {
    text += fmt::format("; {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", s.next, s.not_clear, s.looked_at,
                        int{s.blocked}, int{s.done}, static_cast<int>(s.verdict), s.cycle, s.depth_mm,
                        s.place_M.x(), s.place_M.y(), s.place_M.z(), s.share, s.first_M.x(), s.first_M.y(),
                        s.first_M.z(), s.due);
  }
  return text;
}

bool StockContactCheck::read(std::istream& in) {
  for (Suspect& s : suspects_) {
    char mark = 0;
    int verdict = 0;
    in >> mark >> s.next >> s.not_clear >> s.looked_at >> s.blocked >> s.done >> verdict >> s.cycle >>
        s.depth_mm >> s.place_M.x() >> s.place_M.y() >> s.place_M.z() >> s.share >> s.first_M.x() >>
        s.first_M.y() >> s.first_M.z() >> s.due;
    if (in.fail() || mark != ';' || verdict < 0 || verdict > 2) return false;
    s.verdict = static_cast<StockVerdict>(verdict);
  }
  return true;
}

bool StockContactCheck::resume(const std::string& text, size_t sweeps) {
  std::istringstream in(text);
  size_t count = 0, due = 0;
  uint64_t of = 0;
  int looks = 0;
  bool unseen = false;
  if (!(in >> count)) return false;
  if (count > 0 && !(in >> of >> looks >> unseen >> due)) return false;
  if (suspects_.empty()) return true;
  if (count == suspects_.size() && of == identity()) {
    looks_ = looks;
    unseen_ = unseen;
    due_ = due;
    return read(in);
  }
  due_ = kNever;
  for (Suspect& suspect : suspects_) {
    set_due(suspect);
    if (suspect.due < sweeps) {
      suspect.done = unseen_ = true;
      suspect.cycle = suspect.next;
    } else {
      due_ = std::min(due_, suspect.due);
    }
  }
  return true;
}

std::optional<StockContacts> StockContactCheck::result() const {
  if (suspects_.empty()) return std::nullopt;
  StockContacts found;
  found.suspects = suspects_.size();
  found.seen_mm = seen_mm_;
  found.looks = looks_;
  found.unseen = unseen_;
  for (const Suspect& suspect : suspects_) {
    if (suspect.done && suspect.verdict == StockVerdict::kClear) continue;
    StockEvent event{suspect.of, suspect.verdict, {}, 0, suspect.depth_mm, suspect.place_M, suspect.first_M};
    const uint64_t cycle = suspect.blocked || suspect.done ? suspect.cycle : suspect.next;
    const uint64_t last = suspect.of.cycles.last;
    const motion::Cycle& next = reader_.at(std::min(cycle + 1, last));
    const int element = next.sample.element;
    const double end_s = next.sample.t_s, start_s = reader_.at(cycle).sample.t_s;
    event.first = {cycle, suspect.share, start_s + suspect.share * (end_s - start_s), element};
    event.last_element = reader_.at(last).sample.element;
    found.events.push_back(event);
  }
  return found;
}

}  // namespace swarf::sim
