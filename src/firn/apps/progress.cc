#include <firn/apps/machine.h>
#include <firn/apps/progress.h>
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace firn {

std::string duration_text(double seconds) {
  constexpr double kYear = 365.25 * 24 * 3600;
  if (!(seconds < 2 * kYear)) return fmt::format("{:.2g} years", seconds / kYear);
  const auto whole = static_cast<std::int64_t>(std::llround(std::max(seconds, 0.0)));
  if (whole >= 3600) return fmt::format("{}h {:02}m", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{}m {:02}s", whole / 60, whole % 60);
  return fmt::format("{}s", whole);
}

std::string Progress::line(const FrameReport& report) {
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double done = static_cast<double>(report.frame - first_), all = static_cast<double>(frames_ - first_);
  const double eta = done > 0 ? elapsed / done * (all - done) : 0;
  const double rate = report.wall_seconds > 0 ? static_cast<double>(report.particles) *
                                                    static_cast<double>(report.steps) / report.wall_seconds
                                              : 0;
  const double used = static_cast<double>(resident_memory()), total = static_cast<double>(total_memory());
  if (style_ == Style::json) {
    nlohmann::ordered_json json;
    json["frame"] = report.frame;
    json["frames"] = frames_;
    json["time"] = report.time;
    json["steps"] = report.steps;
    json["dt"] = report.dt;
    json["limit"] = report.limit;
    json["particles"] = report.particles;
    json["parked"] = report.parked;
    json["particle_steps_per_second"] = rate;
    json["memory_bytes"] = resident_memory();
    json["wall_seconds"] = report.wall_seconds;
    json["eta_seconds"] = eta;
    return json.dump();
  }
  std::string line = fmt::format("frame {:04}/{:04} | t {:.3f} s", report.frame, frames_, report.time);
  if (report.steps > 0) {
    line += fmt::format(" | {} steps, dt {:.2g} s ({})", report.steps, report.dt, report.limit);
  }
  line += fmt::format(" | {} particles", report.particles);
  if (report.parked > 0) line += fmt::format(" ({} parked)", report.parked);
  if (report.steps > 0)
    line += fmt::format(" | {:.1f} M particle-steps/s | {:.2f} s", rate * 1e-6, report.wall_seconds);
  line += fmt::format(" | {:.2f}/{:.0f} GiB", used / 0x1p30, total / 0x1p30);
  if (done > 0 && done < all) line += fmt::format(" | ETA {}", duration_text(eta));
  return line;
}

}  // namespace firn
