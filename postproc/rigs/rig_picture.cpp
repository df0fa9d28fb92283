// SPDX-License-Identifier: GPL-2.0-or-later
#include "rigs/rig_picture.h"

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataReader.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSTLReader.h>
#include <vtkScalarBarActor.h>
#include <vtkSphereSource.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTransform.h>
#include <vtkTransformPolyDataFilter.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/bad_input.h"
#include "core/rig_table.h"
#include "picture/film.h"
#include "picture/render.h"

namespace vielto {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 1600, kHeight = 1000;

struct Dump {
  fs::path path;
  long step = -1;
};

// The dumps in the order of their steps: NAME_STEP.vtk or NAME_STEP.stl;
// LIGGGHTS writes the box beside it as NAME_boundingBox_STEP.vtk.
std::vector<Dump> dumps(const fs::path& folder, const char* type) {
  std::vector<Dump> list;
  std::error_code missing;
  for (const auto& file : fs::directory_iterator(folder, missing)) {
    const std::string name = file.path().stem().string();
    if (file.path().extension() != type || name.find("boundingBox") != std::string::npos) continue;
    const auto digits = name.find_last_not_of("0123456789") + 1;
    if (digits == name.size()) continue;
    list.push_back({file.path(), std::stol(name.substr(digits))});
  }
  std::sort(list.begin(), list.end(), [](const Dump& a, const Dump& b) { return a.step < b.step; });
  return list;
}

// The last one, or the last one up to a step.
std::optional<Dump> last_dump(const fs::path& folder, const char* type, std::optional<long> up_to = {}) {
  std::optional<Dump> last;
  for (const Dump& dump : dumps(folder, type))
    if (!up_to || dump.step <= *up_to) last = dump;
  return last;
}

// How the table of rigs has a run drawn, whose record tells which rig it is.
RigPicture picture_of(const fs::path& run) {
  for (const RigDescription& rig : apparatuses())
    if (!rig.record.empty() && fs::exists(run / rig.record)) return rig.picture;
  return {};
}

// Grains with the point data `speed`, m/s, and `diameter`, m; with `over_base`
// those with their centres over z = 0.
vtkNew<vtkPolyData> read_grains(const fs::path& path, bool over_base) {
  vtkNew<vtkPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->ReadAllFieldsOn();
  if (reader->IsFilePolyData()) reader->Update();
  vtkPointData* data = reader->GetOutput()->GetPointData();
  vtkDataArray* const radius = data->GetArray("radius");
  vtkDataArray* const v = data->GetArray("v");
  if (!radius || !v || v->GetNumberOfComponents() != 3)
    throw BadInput(path.string(), 0, "holds no grains with radius and velocity",
                   "dump with 'custom/vtk ... id type x y z vx vy vz radius'");
  vtkNew<vtkDoubleArray> speed, diameter;
  speed->SetName("speed");
  diameter->SetName("diameter");
  vtkNew<vtkPoints> centres;
  for (vtkIdType i = 0; i < radius->GetNumberOfTuples(); ++i) {
    const double* const x = reader->GetOutput()->GetPoint(i);
    if (over_base && x[2] < 0) continue;
    centres->InsertNextPoint(x);
    const double* u = v->GetTuple3(i);
    speed->InsertNextValue(std::hypot(u[0], u[1], u[2]));
    diameter->InsertNextValue(2 * radius->GetTuple1(i));
  }
  vtkNew<vtkPolyData> grains;
  grains->SetPoints(centres);
  grains->GetPointData()->AddArray(speed);
  grains->GetPointData()->AddArray(diameter);
  return grains;
}

// From dark blue over green to yellow, even in lightness: readable in grey and
// with any colour vision.
vtkNew<vtkColorTransferFunction> speed_colours(double most) {
  vtkNew<vtkColorTransferFunction> colours;
  colours->SetColorSpaceToLab();
  colours->AddRGBPoint(0.00 * most, 0.267, 0.005, 0.329);
  colours->AddRGBPoint(0.25 * most, 0.229, 0.322, 0.546);
  colours->AddRGBPoint(0.50 * most, 0.128, 0.567, 0.551);
  colours->AddRGBPoint(0.75 * most, 0.369, 0.789, 0.383);
  colours->AddRGBPoint(1.00 * most, 0.993, 0.906, 0.144);
  return colours;
}

vtkNew<vtkActor> part_actor(const fs::path& path, double degrees, const std::array<double, 3>& axis, double opacity) {
  vtkNew<vtkSTLReader> reader;
  reader->SetFileName(path.c_str());
  vtkNew<vtkTransform> rotation;
  rotation->RotateWXYZ(degrees, axis.data());
  vtkNew<vtkTransformPolyDataFilter> turn;
  turn->SetTransform(rotation);
  turn->SetInputConnection(reader->GetOutputPort());
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(turn->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.72, 0.74, 0.78);
  actor->GetProperty()->SetAmbient(0.25);
  actor->GetProperty()->SetOpacity(opacity);
  return actor;
}

vtkNew<vtkTextActor> caption(const std::string& text, int size, double x, double y) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  actor->GetTextProperty()->SetFontSize(size);
  actor->GetTextProperty()->SetColor(0.1, 0.1, 0.1);
  actor->SetPosition(x, y);
  return actor;
}

// The parts of the rig: what stands translucent, the rest turned as `rotor`
// does after `turns`. Without a rotor the parts are where the last dump of
// meshes has them, or where they began, all of them translucent. False if there
// is none.
bool add_parts(vtkRenderer* renderer, const fs::path& run, const std::vector<std::string>& without,
               const TurningRotor* rotor, double turns, std::optional<long> step) {
  constexpr double kDrum = 0.18, kAnyPart = 0.4;
  if (const auto moved = last_dump(run / "vtk", ".stl", step); moved && !rotor) {
    renderer->AddActor(part_actor(moved->path, 0, {1, 0, 0}, kAnyPart));
    return true;
  }
  bool any = false;
  std::error_code missing;
  for (const auto& file : fs::directory_iterator(run / "mesh", missing)) {
    const std::string part = file.path().stem().string();
    if (file.path().extension() != ".stl" || std::count(without.begin(), without.end(), part) > 0) continue;
    const TurningRotor none;
    const TurningRotor& r = rotor ? *rotor : none;
    const bool stands = std::count(r.standing.begin(), r.standing.end(), part) > 0;
    renderer->AddActor(part_actor(file.path(), stands || !rotor ? 0 : 360 * turns, r.axis,
                                  stands  ? kDrum
                                  : rotor ? 1
                                          : kAnyPart));
    any = true;
  }
  return any;
}

double greatest_speed(vtkPolyData* grains) {
  double range[2] = {0, 0};
  grains->GetPointData()->GetArray("speed")->GetRange(range);
  return range[1];
}

// True if they are coloured by speed, up to `fastest`; grains at rest have none
// worth a colour.
bool add_grains(vtkRenderer* renderer, vtkPolyData* grains, double fastest) {
  constexpr double kRest = 1e-3;  // m/s
  const bool moving = fastest > kRest;
  const auto colours = speed_colours(moving ? fastest : 1);
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(0.5);
  sphere->SetThetaResolution(20);
  sphere->SetPhiResolution(20);
  vtkNew<vtkGlyph3DMapper> spheres;
  spheres->SetInputData(grains);
  spheres->SetSourceConnection(sphere->GetOutputPort());
  spheres->SetScaleModeToScaleByMagnitude();
  spheres->SetScaleArray("diameter");
  spheres->SetScalarModeToUsePointFieldData();
  spheres->SelectColorArray("speed");
  spheres->SetLookupTable(colours);
  if (!moving) spheres->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(spheres);
  actor->GetProperty()->SetColor(0.86, 0.72, 0.42);  // straw
  renderer->AddActor(actor);
  if (!moving) return false;

  vtkNew<vtkScalarBarActor> bar;
  bar->SetLookupTable(colours);
  bar->SetTitle("speed / (m/s)");
  bar->SetNumberOfLabels(6);
  bar->SetLabelFormat("%.2f");
  bar->UnconstrainedFontSizeOn();
  for (vtkTextProperty* text : {bar->GetTitleTextProperty(), bar->GetLabelTextProperty()}) {
    text->SetColor(0.1, 0.1, 0.1);
    text->SetFontSize(24);
    text->ShadowOff();
    text->ItalicOff();
    text->BoldOff();
  }
  bar->SetPosition(0.87, 0.15);
  bar->SetWidth(0.11);
  bar->SetHeight(0.65);
  renderer->AddActor2D(bar);
  return true;
}

// One look at the rig. `fastest`: speed at the end of the scale; nothing: that
// of the dump.
bool draw_look(const std::string& run, const TurningRotor* rotor, const std::optional<Dump>& dump,
               std::optional<double> fastest, const std::string& path) {
  const double turns =
      rotor && dump ? std::max(0.0, (static_cast<double>(dump->step) - rotor->start_step) / rotor->steps_per_turn) : 0;
  const RigPicture picture = picture_of(run);
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  if (!add_parts(renderer, run, picture.without, rotor, turns, dump ? std::optional(dump->step) : std::nullopt))
    return false;
  const char* title = "The rig";
  double shown[6];
  renderer->ComputeVisiblePropBounds(shown);
  if (dump) {
    const auto grains = read_grains(dump->path, picture.close_up);
    title = add_grains(renderer, grains, fastest.value_or(greatest_speed(grains)))
                ? "Grains in the rig, coloured by speed"
                : "Grains in the rig, at rest";
    if (picture.close_up) {
      double diameter[2];
      grains->GetPointData()->GetArray("diameter")->GetRange(diameter);
      grains->GetBounds(shown);  // of the centres
      for (int i = 0; i < 6; ++i) shown[i] += (i % 2 ? 0.5 : -0.5) * diameter[1];
    }
  }
  renderer->AddActor2D(caption(title, 34, 40, kHeight - 70));
  if (rotor)
    renderer->AddActor2D(caption(fmt::format("{}, after {:.2f} turns", rotor->caption, turns), 24, 40, kHeight - 110));

  // A little from above; a shaft from its end for the most part.
  vtkCamera* camera = renderer->GetActiveCamera();
  if (picture.from_side)
    camera->SetPosition(-0.35, -1, 0.2);
  else
    camera->SetPosition(-1, -0.55, 0.35);
  camera->SetFocalPoint(0, 0, 0);
  camera->SetViewUp(0, 0, 1);
  camera->SetViewAngle(25);
  renderer->ResetCamera(shown);
  camera->Zoom(1.15);
  camera->SetWindowCenter(0, 0.08);

  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetAlphaBitPlanes(1);
  renderer->SetUseDepthPeeling(1);
  renderer->SetUseFXAA(true);
  window->SetSize(kWidth, kHeight);
  window->AddRenderer(renderer);
  write_png(window, path);
  return true;
}

}  // namespace

void add_grains(const std::string& run, PostResult& result) {
  result.pictures.push_back({"grains.png", [run](const std::string& path) { draw_rig(run, nullptr, path); }});
  result.film = [run](const std::string& path) { draw_film(run, nullptr, path); };
}

bool has_dump(const std::string& run) { return last_dump(fs::path(run) / "vtk", ".vtk").has_value(); }

bool draw_rig(const std::string& run, const TurningRotor* rotor, const std::string& path) {
  return draw_look(run, rotor, last_dump(fs::path(run) / "vtk", ".vtk"), std::nullopt, path);
}

void draw_film(const std::string& run, const TurningRotor* rotor, const std::string& path) {
  std::vector<Dump> shown = dumps(fs::path(run) / "vtk", ".vtk");
  if (rotor && !shown.empty()) {
    const double after = static_cast<double>(shown.back().step) - rotor->steps_per_turn;
    shown.erase(shown.begin(), std::find_if(shown.begin(), shown.end(), [after](const Dump& dump) {
                  return static_cast<double>(dump.step) > after;
                }));
  }
  if (shown.size() < 2)
    throw BadInput(run.empty() ? "the folder" : run, 0, "holds fewer than two dumps of grains for a film",
                   "run the mixer with -var vtkPerTurn 60, another rig with "
                   "dumps of its own");
  const bool over_base = picture_of(run).close_up;
  double fastest = 0;
  for (const Dump& dump : shown) fastest = std::max(fastest, greatest_speed(read_grains(dump.path, over_base)));
  Film film(path);
  for (const Dump& dump : shown)
    if (!draw_look(run, rotor, dump, fastest, film.next_frame()))
      throw BadInput(run, 0, "holds no mesh/*.stl", "name the folder of a run that is complete");
  film.finish();
}

}  // namespace vielto
