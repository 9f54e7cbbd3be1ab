// Reads the PNG and checks its pixels. The planes' positions are not assumed: a known outline gives
// their scale, then another outline is searched for.
#include "stick_picture/stick_picture.h"

#include <cairo/cairo.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <limits>
#include <numbers>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;
using Rgb = std::array<int, 3>;

constexpr Rgb kVermilion = {213, 94, 0}, kBlue = {0, 114, 178};
constexpr Rgb kInnerZone = {191, 231, 220};  // the zone's colour: a quarter of the green on white
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Picture {
  Surface surface;
  int width = 0, height = 0;
  Rgb at(int x, int y) const {
    std::uint32_t pixel = 0;
    std::memcpy(&pixel,
                cairo_image_surface_get_data(surface.get()) +
                    y * cairo_image_surface_get_stride(surface.get()) + 4 * x,
                4);
    const auto byte = [&pixel](int shift) { return static_cast<int>(pixel >> shift & 0xff); };
    return {byte(16), byte(8), byte(0)};
  }
};

Picture read_png(const std::string& path) {
  Surface surface(cairo_image_surface_create_from_png(path.c_str()));
  const int width = cairo_image_surface_get_width(surface.get());
  const int height = cairo_image_surface_get_height(surface.get());
  EXPECT_GT(width * height, 0);
  return {std::move(surface), width, height};
}

// The pixels of nearly one colour in a column of the page, above the legends.
struct Found {
  int count = 0, left = 100000, right = -1, top = 100000, bottom = -1;
  double x() const { return (left + right) / 2.0; }
  double y() const { return (top + bottom) / 2.0; }
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};
constexpr int kAboveLegends = 575, kRawEnd = 520, kCalibratedEnd = 990;
Found find(const Picture& p, const Rgb& colour, int from_x, int to_x, int tolerance) {
  Found found;
  for (int y = 0; y < kAboveLegends; ++y) {
    for (int x = from_x; x < to_x; ++x) {
      const Rgb c = p.at(x, y);
      bool is_it = true;
      for (std::size_t i = 0; i < 3; ++i) is_it &= std::abs(c[i] - colour[i]) <= tolerance;
      if (!is_it) continue;
      ++found.count;
      found.left = std::min(found.left, x);
      found.right = std::max(found.right, x);
      found.top = std::min(found.top, y);
      found.bottom = std::max(found.bottom, y);
    }
  }
  return found;
}

Outline circle(double radius, const vec2& middle) {
  Outline outline;
  outline.middle = middle;
  outline.radius.fill(radius);
  outline.samples = 1000;
  return outline;
}

struct Made {
  std::vector<StickTrack> tracks;
  StickStatistics statistics;
  StickAdvice advice;
  Made() {
    advice.calibration.shape = ZoneShape::radial;
    advice.verdict = Verdict::good;
    advice.reason = "it is a made one";
  }
  StickPicture picture() const { return {"left stick", tracks, &statistics, &advice}; }
};

class StickPictureFile : public testing::Test {
 protected:
  Picture drawn(const Made& made) {
    const StickPicture picture = made.picture();
    const auto error = write_stick_picture(path, "Pad, 2024-05-04", {&picture, 1});
    EXPECT_FALSE(error) << error->message;
    return read_png(path);
  }

  OwnFolder own;
  const fs::path folder = own.path;
  const std::string path = own.at("plot.png");
};

TEST_F(StickPictureFile, TheOutlineStandsWhereItWasMeasured) {
  Made made;
  made.statistics.outline = circle(0.8, vec2(0.0));
  const Found big = find(drawn(made), kVermilion, 0, kRawEnd, 12);
  ASSERT_GT(big.count, 500);
  EXPECT_NEAR(big.width(), big.height(), 2.0);
  const double scale = big.width() / 1.6;  // pixels per unit, from the first outline

  made.statistics.outline = circle(0.4, {0.2, -0.3});
  const Found small = find(drawn(made), kVermilion, 0, kRawEnd, 12);
  EXPECT_NEAR(small.width(), 0.8 * scale, 2.5);
  EXPECT_NEAR(small.height(), 0.8 * scale, 2.5);
  EXPECT_NEAR(small.x() - big.x(), 0.2 * scale, 1.5);
  EXPECT_NEAR(small.y() - big.y(), 0.3 * scale, 1.5) << "back is down";

  // Changes the left half only.
  for (std::size_t i = 49; i < 144; ++i) made.statistics.outline.radius[i] = 0.0;
  const Found half = find(drawn(made), kVermilion, 0, kRawEnd, 12);
  EXPECT_NEAR(half.width(), 0.4 * scale, 2.5) << "a hole stays open";
  EXPECT_NEAR(half.height(), 0.8 * scale, 2.5);
}

TEST_F(StickPictureFile, TheInnerZoneIsFourQuartersOfEllipses) {
  Made made;
  made.statistics.outline = circle(0.8, vec2(0.0));
  const double scale = find(drawn(made), kVermilion, 0, kRawEnd, 12).width() / 1.6;
  made.statistics.outline = {};
  made.advice.calibration.x = {-0.9, 0.1, 0.7};
  made.advice.calibration.y = {-0.5, -0.1, 0.8};
  made.advice.calibration.inner = 0.5;
  const Found zone = find(drawn(made), kInnerZone, 0, kRawEnd, 4);
  // The inner half of the zone's edge, 1.5 pixels wide, covers the zone's colour; grid lines cross
  // it.
  const double area = std::numbers::pi / 4.0 * (1.0 + 0.6) * (0.4 + 0.9) * 0.25 * scale * scale;
  EXPECT_NEAR(zone.count, area, 0.08 * area);
  EXPECT_NEAR(zone.width(), 0.5 * 1.6 * scale, 4.0);
  EXPECT_NEAR(zone.height(), 0.5 * 1.3 * scale, 4.0);
}

TEST_F(StickPictureFile, TheCalibratedOutlineFillsTheUnitCircle) {
  Made made;
  made.statistics.outline = circle(0.8, vec2(0.0));
  const Picture plain = drawn(made);
  const double scale = find(plain, kVermilion, 0, kRawEnd, 12).width() / 1.6;
  made.statistics.outline = circle(0.6, {0.2, 0.1});
  made.advice.calibration.x = {-0.4, 0.2, 0.8};
  made.advice.calibration.y = {-0.5, 0.1, 0.7};
  const Found outline = find(drawn(made), kVermilion, kRawEnd, kCalibratedEnd, 12);
  EXPECT_NEAR(outline.width(), 2.0 * scale, 2.5);
  EXPECT_NEAR(outline.height(), 2.0 * scale, 2.5);
  const double raw_y = find(plain, kVermilion, 0, kRawEnd, 12).y();
  EXPECT_NEAR(outline.y(), raw_y, 1.5) << "the planes stand side by side";
}

TEST_F(StickPictureFile, TheTrackIsDrawnWhereTheStickWas) {
  Made made;
  made.statistics.outline = circle(0.8, vec2(0.0));
  const Found outline = find(drawn(made), kVermilion, 0, kRawEnd, 12);
  const double scale = outline.width() / 1.6;
  made.statistics.outline = {};
  made.advice.calibration.inner = 0.0;
  made.tracks.resize(1);
  // The track runs often along one line, so that its thin blue adds up; NaN interrupts it.
  for (int k = 0; k < 60; ++k) {
    for (int i = -50; i <= 50; ++i) {
      made.tracks[0].push_back({0, {(k % 2 == 0 ? i : -i) / 100.0, 0.4}});
    }
    made.tracks[0].push_back({0, {kNan, 0.4}});
  }
  const Found track = find(drawn(made), kBlue, 0, kRawEnd, 30);
  EXPECT_NEAR(track.width(), scale, 3.0);
  EXPECT_NEAR(track.y(), outline.y() - 0.4 * scale, 1.5);
  EXPECT_LE(track.height(), 3.0);
}

TEST_F(StickPictureFile, AnUnwritableFileIsOneSentenceAndTheOldOneStays) {
  Made made;
  drawn(made);
  const auto old = fs::file_size(path);
  made.tracks = {{{0, {0.0, 0.0}}, {1, {0.9, 0.9}}}};
  const StickPicture picture = made.picture();
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small = {100, before.rlim_max};
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  const auto error = write_stick_picture(path, "another heading", {&picture, 1});
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->message, path + ": cannot be written: File too large");
  EXPECT_EQ(fs::file_size(path), old);

  const auto below_a_file = write_stick_picture(path + "/x.png", "", {&picture, 1});
  ASSERT_TRUE(below_a_file);
  EXPECT_EQ(below_a_file->message.find('\n'), std::string::npos);
  const auto is_folder = write_stick_picture(folder.string(), "", {&picture, 1});
  ASSERT_TRUE(is_folder);
  EXPECT_EQ(fs::file_size(path), old);
  EXPECT_EQ(own.entries(), 1) << "nothing is left behind";
}

// Draws names and numbers that are invalid, and no data at all.
TEST_F(StickPictureFile, OddValuesAreDrawnAroundNotThrough) {
  Made odd;
  odd.statistics.centre = vec2(kNan, 1e300);
  odd.statistics.sigma = vec2(kNan);
  odd.statistics.rests = {vec2(kNan), vec2(1e300), vec2(0.0)};
  odd.statistics.outline = circle(1e300, vec2(kNan));
  odd.statistics.outline.radius[3] = kNan;
  odd.statistics.min_x = odd.statistics.circularity_error = odd.statistics.rate_hz = kNan;
  odd.advice.calibration.x = {kNan, kNan, kNan};
  odd.advice.calibration.inner = kNan;
  odd.advice.reason =
      std::string(5000, 'w') + " \xff\xc3\x28\xed\xa0\x80\n" + std::string(5000, ' ');
  odd.tracks = {{}, {{0, vec2(kNan)}, {0, vec2(1e300)}, {0, vec2(-1e300)}}};
  const StickPicture pictures[] = {odd.picture(), {"\xfe", {}, nullptr, nullptr}, {}};
  const auto error = write_stick_picture(path, "Pad \xf0\x9f\x8e\xae \x01,\xff", pictures);
  ASSERT_FALSE(error) << error->message;
  const Picture pixels = read_png(path);
  EXPECT_EQ(pixels.width, 1500);
  EXPECT_GT(pixels.height, 3 * 600);
  ASSERT_FALSE(write_stick_picture(path, "", {}));
  EXPECT_EQ(read_png(path).width, 1500);
}

// A track of half an hour at 1 kHz, never at rest.
TEST_F(StickPictureFile, ALongTrackIsThinnedOut) {
  Made made;
  made.tracks.resize(1);
  for (int i = 0; i < 1800000; ++i) {
    const double angle = i * 0.37;
    made.tracks[0].push_back(
        {i * std::int64_t{1000000}, vec2(std::cos(angle), std::sin(angle * 1.1)) * 0.9});
  }
  const std::clock_t before = std::clock();  // processor time
  drawn(made);
  EXPECT_LT(std::clock() - before, 20 * CLOCKS_PER_SEC);
}

TEST(StickPictureDeathTest, WithoutAnyFontItIsDrawnAllTheSame) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        auto own = std::make_unique<OwnFolder>();
        const std::string none =
            own->write("fonts.conf", "<?xml version=\"1.0\"?><fontconfig></fontconfig>");
        ::setenv("FONTCONFIG_FILE", none.c_str(), 1);
        Made made;
        made.statistics.outline = circle(0.8, vec2(0.0));
        const StickPicture picture = made.picture();
        const auto error = write_stick_picture(own->at("plot.png"), "Pad", {&picture, 1});
        const bool is_drawn = !error && fs::file_size(own->at("plot.png")) > 10000;
        own.reset();
        std::_Exit(is_drawn ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace gaitpad
