// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "floor_maps.hpp"

#include "trussmap/map_files.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

std::string file_of(Channel channel, const char* ending) {
  return fmt::format("floor-{}{}", name_of(channel), ending);
}

}  // namespace

void add_floor_map_option(const Command& command, std::string& folder) {
  command
      .add_option("--floor-map", folder,
                  draws_png() ? "Folder to write what differs from place to place to: a map of "
                                "cells (GeoJSON) and a picture (PNG) of each channel"
                              : "Folder to write what differs from place to place to: a map of "
                                "cells (GeoJSON) of each channel (no pictures: built without "
                                "libpng)")
      .type_name("DIR");
}

void add_floor_maps(Files& files, const std::vector<FieldOfPlaces>& fields,
                    const std::string& folder) {
  if (folder.empty()) return;
  if (fields.empty() && !std::filesystem::exists(folder)) return;
  FolderOfFiles& maps = files.folders.emplace_back();
  maps.folder = folder;
  for (const FieldOfPlaces& one : fields) {
    maps.files.emplace_back(file_of(one.channel, ".geojson"), format_geojson(one));
    if (draws_png()) maps.files.emplace_back(file_of(one.channel, ".png"), floor_png(one));
  }
  for (const Channel channel : {Channel::travel, Channel::turn, Channel::creep, Channel::compass}) {
    if (std::ranges::find(fields, channel, &FieldOfPlaces::channel) != fields.end()) continue;
    for (const char* ending : {".geojson", ".png"}) {
      maps.gone.push_back(file_of(channel, ending));
    }
  }
}

std::string floor_maps_text(const std::vector<FieldOfPlaces>& fields, const std::string& folder) {
  if (folder.empty()) return "";
  if (fields.empty()) return "\nNothing differs from place to place: no floor map\n";
  std::string text = "\n";
  for (const FieldOfPlaces& one : fields) {
    text += fmt::format(
        "map of {} in {}\n", name_of(one.channel),
        (std::filesystem::path(folder) / file_of(one.channel, draws_png() ? ".png" : ".geojson"))
            .string());
  }
  return text;
}

}  // namespace trussmap::app
