#include <fmt/format.h>

#include <utility>

#include "base/text.h"
#include "files/height_picture.h"
#include "files/input_files.h"
#include "files/toml_file.h"
#include "gaitpad/config_files.h"

namespace gaitpad {

namespace {

constexpr double kMost_m = 1000.0;
// Default curvature of a rounding: a sole of 0.25 m bends by 2 mm.
constexpr double kUsualBend_1_m = 0.25;

double length_of(TomlTable& section) {
  section.require("length_m");
  return section.number("length_m", 0.0, kMost_m).value_or(1.0);
}

SectionShape flat_of(TomlTable& section) { return FlatSection{length_of(section)}; }

SectionShape slope_of(TomlTable& section) {
  SlopeSection slope;
  slope.length_m = length_of(section);
  const auto grade = section.number("grade", -1.0, 1.0);
  const auto angle_deg = section.number("angle_deg", -45.0, 45.0);
  if (grade && angle_deg) section.reject("angle_deg", "a slope has a grade or an angle, not both");
  if (!grade && !angle_deg) section.require("grade");
  if (grade) slope.grade = *grade;
  if (angle_deg) {
    const SinCos s = sin_cos(*angle_deg * kDegree);
    slope.grade = s.sin / s.cos;
  }
  const double usual_m = std::max(0.1, fabs(slope.grade) / kUsualBend_1_m);
  slope.rounding_m =
      section.number("rounding_m", 0.0, kMost_m).value_or(std::min(usual_m, 0.5 * slope.length_m));
  return slope;
}

SectionShape stairs_of(TomlTable& section) {
  StairsSection stairs;
  section.require("count");
  stairs.rise_m = section.number("rise_m", -1.0, 1.0).value_or(stairs.rise_m);
  stairs.tread_m = section.number("tread_m", 0.0, 10.0).value_or(stairs.tread_m);
  stairs.count = static_cast<int>(section.integer("count", 1, 100).value_or(1));
  return stairs;
}

double fade_of(TomlTable& section) { return section.number("fade_m", 0.0, kMost_m).value_or(2.0); }

SectionShape rough_of(TomlTable& section) {
  const double length_m = length_of(section);
  section.require("amplitude_m");
  const double amplitude_m = section.number("amplitude_m", 0.0, 10.0).value_or(0.0);
  const double wavelength_m = section.number("wavelength_m", 0.1, kMost_m).value_or(2.0);
  const auto seed = section.integer("seed", 0, 0xffffffff).value_or(1);
  return rough_section(length_m, amplitude_m, wavelength_m, fade_of(section),
                       static_cast<std::uint32_t>(seed));
}

// Forward is up in the picture, seen from above: its bottom row is the field's first row, its left
// column is at the walker's left.
std::shared_ptr<const HeightField> field_of(const HeightPicture& picture, double low_m,
                                            double high_m) {
  auto field = std::make_shared<HeightField>();
  field->columns = picture.columns, field->rows = picture.rows;
  field->height_m.reserve(picture.samples.size());
  for (int row = picture.rows - 1; row >= 0; --row) {
    for (int column = 0; column < picture.columns; ++column) {
      const int grey =
          picture
              .samples[static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.columns) +
                       static_cast<std::size_t>(column)];
      field->height_m.push_back(static_cast<float>(mix(low_m, high_m, grey / 65535.0)));
    }
  }
  return field;
}

SectionShape picture_of(TomlTable& section, const std::string& path) {
  FieldSection field;
  for (const char* key : {"picture", "low_m", "high_m"}) section.require(key);
  const std::string name = section.string("picture").value_or("");
  field.pixel_m = section.number("metres_per_pixel", 0.001, 100.0).value_or(field.pixel_m);
  field.fade_m = fade_of(section);
  const double low_m = section.number("low_m", -100.0, 100.0).value_or(0.0);
  const double high_m = section.number("high_m", -100.0, 100.0).value_or(0.0);
  const auto picture = load_height_picture(beside(path, name));
  if (!picture) {
    section.reject("picture", picture.error().message);
    return field;
  }
  field.field = field_of(*picture, low_m, high_m);
  field.length_m = (picture->rows - 1) * field.pixel_m;
  return field;
}

void read_section(TomlTable& section, const std::string& path, Terrain& terrain) {
  section.require("kind");
  const std::string kind = section.string("kind").value_or("flat");
  SectionShape shape;
  if (kind == "flat") {
    shape = flat_of(section);
  } else if (kind == "slope") {
    shape = slope_of(section);
  } else if (kind == "stairs") {
    shape = stairs_of(section);
  } else if (kind == "rough") {
    shape = rough_of(section);
  } else if (kind == "picture") {
    shape = picture_of(section, path);
  } else {
    section.reject("kind", "there is no section of kind " + in_quotes(kind) +
                               " (known: flat, slope, stairs, rough, picture)");
    return;
  }
  if (const auto problem = add_section(terrain, shape)) section.reject("kind", problem->message);
}

TerrainZone zone_of(TomlTable& table, const std::string& path) {
  TerrainZone zone;
  for (const char* key : {"from_m", "to_m", "style"}) table.require(key);
  const auto read = [&](const char* key, double& value) {
    value = table.number(key, -1e4, 1e4).value_or(value);
  };
  read("from_m", zone.from_m);
  read("to_m", zone.to_m);
  read("left_m", zone.left_m);
  read("right_m", zone.right_m);
  if (table.has("to_m") && !(zone.from_m < zone.to_m))
    table.reject("to_m", "the zone ends before it begins");
  if (!(zone.right_m < zone.left_m))
    table.reject("right_m", "the zone's right is left of its left (x grows to the left)");
  zone.style = table.string("style").value_or("");
  if (zone.style.empty()) table.reject("style", "the style's name is empty");
  zone.where = fmt::format("{}:{}", path, table.line("style"));
  return zone;
}

Result<Terrain> terrain_of(Result<TomlFile> file, const std::string& path) {
  if (!file) return file.error();
  TomlTable root = file->root();
  Terrain terrain;
  terrain.name = root.string("name").value_or(config_name(path));
  if (terrain.name.empty()) root.reject("name", "the name is empty");
  for (TomlTable& section : root.tables("section", kMaxSections))
    read_section(section, path, terrain);
  for (TomlTable& zone : root.tables("zone", kMaxZones))
    terrain.zones.push_back(zone_of(zone, path));
  if (auto problem = file->problem()) return *problem;
  return terrain;
}

}  // namespace

Result<Terrain> load_terrain(const std::string& path) {
  return terrain_of(TomlFile::load(path), path);
}

Result<Terrain> parsed_terrain(std::string_view text, const std::string& path) {
  return terrain_of(TomlFile::parse(text, path), path);
}

}  // namespace gaitpad
