// SPDX-License-Identifier: GPL-2.0-or-later
// The mixer's meshes against the geometry of the drawing, with VTK as an independent judge of closedness and volume.
#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkCleanPolyData.h>
#include <vtkFeatureEdges.h>
#include <vtkMassProperties.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <cmath>

#include "rig_meshes.h"

using namespace vielto_test;

namespace {

Rig mixer(const Settings& settings = {}) { return rig("mixer", settings); }

std::string refusal(const Settings& settings) { return vielto_test::refusal("mixer", settings); }

vtkSmartPointer<vtkPolyData> poly_data(const Triangles& triangles) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  for (const Triangle& t : triangles) {
    vtkIdType ids[3];
    for (int i = 0; i < 3; ++i) ids[i] = points->InsertNextPoint(t[i].data());
    cells->InsertNextCell(3, ids);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputData(data);
  clean->ToleranceIsAbsoluteOn();
  clean->SetAbsoluteTolerance(1e-10);
  clean->Update();
  return clean->GetOutput();
}

long edges(const Triangles& triangles, bool open) {
  vtkNew<vtkFeatureEdges> filter;
  filter->SetInputData(poly_data(triangles));
  filter->FeatureEdgesOff();
  filter->ManifoldEdgesOff();
  filter->SetBoundaryEdges(open);
  filter->SetNonManifoldEdges(!open);
  filter->Update();
  return filter->GetOutput()->GetNumberOfCells();
}

double vtk_volume(const Triangles& triangles) {
  vtkNew<vtkMassProperties> mass;
  mass->SetInputData(poly_data(triangles));
  return mass->GetVolume();
}

Point normal(const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]).normalized(); }
Point centre(const Triangle& t) { return (t[0] + t[1] + t[2]) / 3; }

constexpr double R = 0.125, kHeight = 0.270, kLength = 0.765;

// Half circle in n inscribed chords, n/2 R^2 sin(pi/n), plus the straight sides.
double chord_area(int n) { return n / 2.0 * R * R * std::sin(kPi / n) + 2 * R * (kHeight - R); }

}  // namespace

TEST(MixerDrum, HoldsTheOutlinesVolumeLessWhatItsChordsCutOff) {
  const double outline = kLength * (kPi * R * R / 2 + 2 * R * (kHeight - R));
  EXPECT_NEAR(outline * 1e3, 46.51, 0.005);  // not the booklet's 47.4 dm3
  for (const int n : {24, 48, 96}) {
    const double volume =
        mixer({{"slicePaddles", "0"}, {"drumSegments", std::to_string(n)}}).number("meshedDrumVolume");
    EXPECT_NEAR(volume, kLength * chord_area(n), 1e-8 * outline);  // nine digits are written
    EXPECT_LT(volume, outline);
    EXPECT_NEAR(outline - volume, kLength * R * R * kPi * kPi * kPi / (12.0 * n * n), 2e-3 * (outline - volume) + 1e-9);
  }
}

TEST(MixerDrum, OfASliceHoldsItsShareOfTheLength) {
  EXPECT_NEAR(mixer().number("meshedDrumVolume"), 4 * kLength / 22 * chord_area(48), 1e-11);
  EXPECT_NEAR(mixer().number("sliceLength"), 4 * kLength / 22, 1e-12);
}

TEST(MixerDrum, FacesTheGrains) {
  for (const char* slice : {"0", "4"}) {
    const Rig m = mixer({{"slicePaddles", slice}});
    for (const Triangle& t : m.part("drum")) {
      const Point inside(kLength / 2 * (slice[0] == '0' ? 1 : 4.0 / 22), 0, 0);
      EXPECT_GT(normal(t).dot(inside - centre(t)), 0);
    }
  }
}

TEST(MixerDrum, VerticesLieOnTheCircleAndTheStraightSides) {
  const Rig m = mixer();
  for (const Triangle& t : m.part("drum"))
    for (const Point& p : t) {
      if (p.z() < -1e-12)
        EXPECT_NEAR(std::hypot(p.y(), p.z()), R, 1e-15);
      else
        EXPECT_NEAR(std::fabs(p.y()), R, 1e-15);
    }
}

TEST(MixerDrum, OfASliceHasNoEndWallsAndSpansExactlyThePeriod) {
  const Rig m = mixer();
  const Measure size = measure(m.part("drum"));
  EXPECT_EQ(size.low.x(), 0);
  EXPECT_DOUBLE_EQ(size.high.x(), 4 * kLength / 22);
  for (const Triangle& t : m.part("drum")) EXPECT_LT(std::fabs(normal(t).x()), 1e-12);
}

TEST(MixerDrum, OfTheWholeIsOpenAtTheTopOnly) {
  const Rig m = mixer({{"slicePaddles", "0"}});
  EXPECT_EQ(edges(m.part("drum"), false), 0);
  long rim = 0;
  for (const Triangle& t : m.part("drum"))
    for (int i = 0; i < 3; ++i)
      if (std::fabs(t[i].z() - (kHeight - R)) < 1e-12 && std::fabs(t[(i + 1) % 3].z() - (kHeight - R)) < 1e-12) ++rim;
  EXPECT_GT(rim, 0);
  EXPECT_EQ(edges(m.part("drum"), true), rim);
}

TEST(MixerPaddle, IsAClosedPlateOfTheStatedVolumeFacingOutward) {
  const Rig m = mixer();
  for (const char* name : {"paddle_2", "paddle_3"}) {  // 1 and 4 are cut by the period
    EXPECT_EQ(edges(m.part(name), true), 0);
    EXPECT_EQ(edges(m.part(name), false), 0);
    EXPECT_NEAR(vtk_volume(m.part(name)), 0.050 * 0.020 * 0.002, 1e-12);
    EXPECT_NEAR(measure(m.part(name)).volume, 0.050 * 0.020 * 0.002, 1e-17);  // signed: outward
  }
  const Triangles whole = mixer({{"slicePaddles", "0"}}).part("paddle_1");
  EXPECT_EQ(edges(whole, true), 0);
  EXPECT_EQ(whole.size(), 22u * 12);
  EXPECT_NEAR(measure(whole).volume, 22 * 2e-6, 1e-16);
}

TEST(MixerPaddle, ThatCrossesThePeriodIsCutThereAndItsOutsidePieceShifted) {
  const Rig m = mixer();
  const double length = 4 * kLength / 22;
  for (const char* name : {"paddle_1", "paddle_4"}) {
    const Triangles& cut = m.part(name);
    const Measure size = measure(cut);
    EXPECT_EQ(size.low.x(), 0);
    EXPECT_DOUBLE_EQ(size.high.x(), length);
    EXPECT_NEAR(size.area, 2 * (0.05 * 0.02 + 0.05 * 0.002 + 0.02 * 0.002), 1e-15);  // no cap
    Triangles row;
    for (int copy = 0; copy < 2; ++copy)
      for (Triangle t : cut) {
        for (Point& p : t) p.x() += copy * length;
        row.push_back(t);
      }
    EXPECT_EQ(edges(row, true), edges(cut, true));  // the image closes one of the two cuts it meets
    EXPECT_GT(edges(cut, true), 0);
  }
}

TEST(MixerPaddle, StandsAtItsAngleCountedFromYToZAndAtItsPlaceOnTheShaft) {
  const Rig m = mixer();
  const double pitch = kLength / 22;
  for (int i : {1, 2}) {
    Point mean = Point::Zero();
    double area = 0;
    for (const Triangle& t : m.part("paddle_" + std::to_string(i + 1))) {
      const double a = (t[1] - t[0]).cross(t[2] - t[0]).norm();
      mean += a * centre(t);
      area += a;
    }
    mean /= area;
    const double angle = i * kPi / 2;
    EXPECT_NEAR((mean - Point((i + 0.5) * pitch, 0.114 * std::cos(angle), 0.114 * std::sin(angle))).norm(), 0, 1e-15);
  }
}

// The face that leads in positive rotation has the normal cos(10 deg) ahead + sin(10 deg) x.
TEST(MixerPaddle, OfPositiveInclinationPushesTowardsPositiveX) {
  const auto leading = [](const Settings& settings, const std::string& name, const Point& ahead) {
    const Rig m = mixer(settings);
    double largest = 0;
    Point at = Point::Zero();
    for (const Triangle& t : m.part(name)) {
      const double a = (t[1] - t[0]).cross(t[2] - t[0]).norm();
      if (normal(t).dot(ahead) > 0.5 && a > largest) {
        largest = a;
        at = normal(t);
      }
    }
    return at;
  };
  const double tilt = std::sin(10 * kPi / 180);
  EXPECT_NEAR(leading({}, "paddle_2", {0, -1, 0}).x(), tilt, 1e-12);
  EXPECT_NEAR(leading({}, "paddle_3", {0, 0, -1}).x(), tilt, 1e-12);
  EXPECT_NEAR(leading({{"paddleHanding", "alternating"}}, "paddle_2", {0, -1, 0}).x(), -tilt, 1e-12);
  EXPECT_NEAR(leading({{"paddleHanding", "alternating"}}, "paddle_3", {0, 0, -1}).x(), tilt, 1e-12);
  EXPECT_NEAR(leading({{"paddleHanding", "mirrored"}}, "paddle_2", {0, -1, 0}).x(), tilt, 1e-12);
  EXPECT_NEAR(leading({{"paddleHanding", "mirrored"}}, "paddle_3", {0, 0, -1}).x(), -tilt, 1e-12);
}

// The corner of the tip face lies 25 mm sin(10 deg) + 1 mm cos(10 deg) beside the radius through the paddle's middle.
TEST(MixerClearance, IsTheTipsAndTheCornersStickOutBeyondIt) {
  const Rig m = mixer();
  const double aside = 0.025 * std::sin(10 * kPi / 180) + 0.001 * std::cos(10 * kPi / 180);
  const double corner = std::hypot(0.124, aside);
  EXPECT_NEAR(m.number("rotorTipRadius"), corner, 1e-12);
  EXPECT_NEAR(m.number("meshClearance"), R * std::cos(kPi / 96) - corner, 1e-9);  // six digits are written
}

// The paddle's edge of 50 mm lies along the axis, turned by 10 deg; outer stems are (drum length - 21 pitches)/2 from
// the walls.
TEST(MixerClearance, ToTheEndWallsIsThatOfTheOuterPaddles) {
  const double half = 0.025 * std::cos(10 * kPi / 180) + 0.001 * std::sin(10 * kPi / 180);
  for (const char* pitch : {"0.033", "0.031"}) {
    const Rig m = mixer({{"slicePaddles", "0"}, {"paddlePitch", pitch}});
    EXPECT_NEAR(m.number("endGap"), (kLength - 21 * std::stod(pitch)) / 2 - half, 1e-7);  // six digits are written
  }
  EXPECT_GT(mixer().number("endGap"), kLength);  // a slice has no end walls
}

TEST(MixerClearance, EatenUpByTheChordsIsRefusedWithTheSmallestCountThatDoes) {
  const std::string twelve = refusal({{"drumSegments", "12"}});
  EXPECT_NE(twelve.find("drumSegments"), std::string::npos) << twelve;
  const auto at = twelve.find("state ");
  ASSERT_NE(at, std::string::npos) << twelve;
  const int enough = std::stoi(twelve.substr(at + 6));
  const double aside = 0.025 * std::sin(10 * kPi / 180) + 0.001 * std::cos(10 * kPi / 180);
  EXPECT_GT(R * std::cos(kPi / (2 * enough)), std::hypot(0.124, aside));
  EXPECT_LE(R * std::cos(kPi / (2 * (enough - 1))), std::hypot(0.124, aside));
  EXPECT_EQ(refusal({{"drumSegments", std::to_string(enough)}}), "accepted");
  EXPECT_NE(refusal({{"drumSegments", std::to_string(enough - 1)}}), "accepted");
}

TEST(MixerClearance, ThatNoChordCountCanSaveIsRefused) {
  EXPECT_NE(refusal({{"clearance", "0.0001"}}).find("larger clearance"), std::string::npos);  // corners need 0.114 mm
}

TEST(MixerWholeDrum, KeepsItsPaddlesOffTheEndWalls) {
  const Rig m = mixer({{"slicePaddles", "0"}});
  const Measure paddles = measure(m.part("paddle_1"));
  const double half = 0.025 * std::cos(10 * kPi / 180) + 0.001 * std::sin(10 * kPi / 180);
  EXPECT_NEAR(paddles.low.x(), (kLength - 21 * 0.033) / 2 - half, 1e-15);
  EXPECT_NEAR(paddles.high.x(), kLength - paddles.low.x(), 1e-15);
  EXPECT_NE(refusal({{"slicePaddles", "0"}, {"paddlePitch", "0.0347727"}}).find("end walls"), std::string::npos);
}

TEST(MixerShaft, IsAnOpenTubeThatEndsInTheWallsWithoutAFaceOfItsOwnThere) {
  const Rig m = mixer({{"slicePaddles", "0"}});
  const Measure size = measure(m.part("shaft"));
  EXPECT_EQ(size.low.x(), 0);
  EXPECT_EQ(size.high.x(), kLength);
  EXPECT_NEAR(largest_radius(m.part("shaft")), 0.0225, 1e-15);
  for (const Triangle& t : m.part("shaft")) {
    EXPECT_LT(std::fabs(normal(t).x()), 1e-12);
    EXPECT_GT(normal(t).dot(Point(0, centre(t).y(), centre(t).z())), 0);
  }
  EXPECT_EQ(edges(m.part("shaft"), true), 2 * 24);
}

// A grain of radius 1 mm or more that overlaps the shaft by less than 5 mm cannot feel a face that lies that deep.
TEST(MixerStem, BeginsDeepInsideTheShaftAndEndsInsideThePaddlesRange) {
  const Rig m = mixer();
  const Triangles& stems = m.part("stems");
  EXPECT_EQ(stems.size(), 4u * 12);
  EXPECT_EQ(edges(stems, true), 0);
  EXPECT_GT(measure(stems).volume, 0);
  double start = 1, end = 0;
  for (const Triangle& t : stems)
    for (const Point& p : t) {
      start = std::min(start, std::hypot(p.y(), p.z()));
      end = std::max(end, std::max(std::fabs(p.y()), std::fabs(p.z())));
    }
  EXPECT_LT(start, 0.0225 * std::cos(kPi / 24) - 0.005);
  EXPECT_NEAR(end, 0.104 + 0.002, 1e-15);  // past the paddle's inner edge at 0.104, short of its tip at 0.124
}

TEST(MixerMesh, HasNoTriangleThatLiggghtsDislikes) {
  for (const char* slice : {"0", "2", "4", "6"}) {
    const Rig m = mixer({{"slicePaddles", slice}});
    for (const Part& part : m.geometry.parts)
      EXPECT_GT(measure(part.triangles).smallest_angle, 1.0 * kPi / 180) << part.name;
  }
}

TEST(MixerMesh, StaysSmall) {
  EXPECT_LE(mixer().number("triangles"), 300);
  EXPECT_EQ(mixer().number("paddleMeshes"), 4);
  EXPECT_EQ(mixer({{"slicePaddles", "0"}}).number("paddleMeshes"), 1);
}

// Four paddles at 0, 90, 180, 270 degrees look the same after a quarter turn; two at 0 and 90 only after a whole one.
TEST(MixerTurn, FallsIntoPartsAfterWhichASliceLooksTheSame) {
  EXPECT_EQ(mixer().number("turnParts"), 4);
  EXPECT_EQ(mixer({{"slicePaddles", "8"}}).number("turnParts"), 4);
  EXPECT_EQ(mixer({{"slicePaddles", "6"}}).number("turnParts"), 1);
  EXPECT_EQ(mixer({{"slicePaddles", "2"}}).number("turnParts"), 1);
  EXPECT_EQ(mixer({{"slicePaddles", "2"}, {"paddleAngleStep", "180"}}).number("turnParts"), 2);
  EXPECT_EQ(mixer({{"paddleAngleStep", "-90"}}).number("turnParts"), 4);
  EXPECT_EQ(mixer({{"paddleHanding", "alternating"}}).number("turnParts"), 1);
  EXPECT_EQ(mixer({{"slicePaddles", "0"}}).number("turnParts"), 1);
}

TEST(MixerInput, ThatMakesNoMixerIsRefused) {
  EXPECT_NE(refusal({{"slicePaddles", "1"}}).find("slicePaddles"), std::string::npos);
  EXPECT_NE(refusal({{"slicePaddles", "2.5"}}).find("whole number"), std::string::npos);
  EXPECT_NE(refusal({{"slicePaddles", "23"}}).find("slicePaddles"), std::string::npos);
  EXPECT_NE(refusal({{"slicePaddles", "3"}, {"paddleHanding", "alternating"}}).find("even"), std::string::npos);
  EXPECT_NE(refusal({{"paddleHanding", "crooked"}}).find("mirrored"), std::string::npos);
  EXPECT_NE(refusal({{"paddleAngleStep", "0"}, {"paddleInclination", "0"}}).find("intersect"), std::string::npos);
  EXPECT_NE(refusal({{"paddleThickness", "-0.002"}}).find("above 0"), std::string::npos);
  EXPECT_NE(refusal({{"clearance", "nan"}}).find("finite"), std::string::npos);
  EXPECT_NE(refusal({{"drumHeight", "0.1"}}).find("drumHeight"), std::string::npos);
  EXPECT_NE(refusal({{"shaftDiameter", "0.21"}}).find("shaftDiameter"), std::string::npos);
  EXPECT_NE(refusal({{"stemWidth", "0.045"}}).find("stemWidth"), std::string::npos);
  EXPECT_NE(refusal({{"stemOverlap", "0.02"}}).find("stemOverlap"), std::string::npos);
  EXPECT_NE(refusal({{"rig", "blender"}}).find("shearbox"), std::string::npos);
}
