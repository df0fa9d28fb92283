// SPDX-License-Identifier: GPL-2.0-or-later
#include "geometry/geometry_output.h"

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkAppendPolyData.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkLightKit.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkWindowToImageFilter.h>
#include <vtkXMLPolyDataWriter.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/bad_input.h"
#include "core/csv.h"
#include "core/sha256.h"
#include "geometry/stl.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;

vtkSmartPointer<vtkPolyData> poly_data(const Part& part) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkStringArray> names;
  names->SetName("part");
  for (const Triangle& t : part.triangles) {
    vtkIdType ids[3];
    for (int i = 0; i < 3; ++i) ids[i] = points->InsertNextPoint(t[i].data());
    cells->InsertNextCell(3, ids);
    names->InsertNextValue(part.name);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetCellData()->AddArray(names);
  return data;
}

void write_vtp(const RigGeometry& geometry, bool moving, const std::string& path) {
  vtkNew<vtkAppendPolyData> all;
  for (const Part& part : geometry.parts)
    if (part.moves == moving) all->AddInputData(poly_data(part));
  if (all->GetNumberOfInputConnections(0) == 0) return;
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(all->GetOutputPort());
  writer->SetFileName((path + ".partial").c_str());
  if (writer->Write() == 0) throw std::runtime_error(path + ": cannot be written");
  fs::rename(path + ".partial", path);
}

std::array<double, 3> colour(const std::string& kind) {
  if (kind == "paddle" || kind == "plate") return {0.85, 0.33, 0.10};
  if (kind == "stems") return {0.93, 0.69, 0.13};
  if (kind == "shaft") return {0.35, 0.35, 0.40};
  return {0.55, 0.70, 0.85};
}

}  // namespace

std::string geometry_par(const RigGeometry& geometry, const GeometryInput& input) {
  std::string text =
      "# Made by 'vielto geometry' together with the meshes beside it; include it in the LIGGGHTS script.\n";
  for (const auto& [name, value] : geometry.derived) text += fmt::format("variable {} index {}\n", name, value);
  text += "# The values the meshes were made with. A run with another value is stopped.\n";
  for (const GeometryInput::Used& used : input.used()) {
    text += fmt::format("variable {} index {}\n", used.name, used.value);
    std::string differs = fmt::format("${{{}}} != {}", used.name, used.value);
    if (used.is_text) {
      text += fmt::format("variable {}_{} index 1\nvariable {}_${{{}}} index 0\n", used.name, used.value, used.name,
                          used.name);
      text += fmt::format("variable {}_same equal v_{}_${{{}}}\n", used.name, used.name, used.name);
      differs = fmt::format("${{{}_same}} == 0", used.name);
    }
    // no quotes around the words: LIGGGHTS does not substitute ${} in quoted text
    text += fmt::format(
        "if \"{}\" then \"vielto error {} is ${{{}}} but the mesh in this folder was made with {}; make it anew with "
        "vielto geometry or drop -var {}\"\n",
        differs, used.name, used.name, used.value, used.name);
  }
  return text;
}

std::string inputs_json(const RigGeometry& geometry) {
  nlohmann::ordered_json hashes;
  for (const std::string& file : geometry.inputs) hashes[file] = sha256_of_file(file);
  return hashes.dump(2) + "\n";
}

void write_geometry(const RigGeometry& geometry, const GeometryInput& input, const std::string& folder) {
  const fs::path out(folder);
  for (const std::string& file : geometry.inputs)
    for (const Part& part : geometry.parts)
      if (fs::weakly_canonical(file) == fs::weakly_canonical(out / (part.name + ".stl")))
        throw BadInput(file, 0, fmt::format("would be overwritten by part {} that is made from it", part.name),
                       "name another folder with --out");
  const bool made = fs::create_directories(out);
  try {
    fs::remove(out / "geometry.par");
    for (int i = 1; fs::remove(out / fmt::format("paddle_{}.stl", i)); ++i) {
    }
    for (const Part& part : geometry.parts) write_stl((out / (part.name + ".stl")).string(), part.name, part.triangles);
    for (const auto& [name, text] : geometry.files) write_whole_file((out / name).string(), text);
    write_vtp(geometry, true, (out / "rotor.vtp").string());
    write_vtp(geometry, false, (out / "drum.vtp").string());
    if (!geometry.inputs.empty()) write_whole_file((out / "inputs.json").string(), inputs_json(geometry));
    write_whole_file((out / "geometry.par").string(), geometry_par(geometry, input));
  } catch (...) {
    std::error_code ignored;
    if (made) fs::remove_all(out, ignored);
    throw;
  }
}

void write_picture(const RigGeometry& geometry, const std::string& path) {
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  for (const Part& part : geometry.parts) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(poly_data(part));
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    const auto rgb = colour(part.kind);
    actor->GetProperty()->SetColor(rgb[0], rgb[1], rgb[2]);
    actor->GetProperty()->SetInterpolationToFlat();
    if (part.kind == "drum") {
      actor->GetProperty()->SetOpacity(0.35);
      actor->GetProperty()->EdgeVisibilityOn();
      actor->GetProperty()->SetEdgeColor(0.6, 0.65, 0.7);
    }
    renderer->AddActor(actor);
  }
  vtkNew<vtkLightKit> lights;
  lights->AddLightsToRenderer(renderer);
  renderer->GetActiveCamera()->SetPosition(0.7, -1.0, 0.6);
  renderer->GetActiveCamera()->SetFocalPoint(0, 0, 0);
  renderer->GetActiveCamera()->SetViewUp(0, 0, 1);
  renderer->ResetCamera();
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(8);
  window->SetSize(1400, 1000);
  window->AddRenderer(renderer);
  window->Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(window);
  image->ReadFrontBufferOff();
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName((path + ".partial").c_str());
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
  if (!fs::exists(path + ".partial")) throw std::runtime_error(path + ": cannot be written");
  fs::rename(path + ".partial", path);
}

}  // namespace vielto
