#pragma once

#include "report/arrows.h"
#include "report/picture.h"

#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkScalarsToColors.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <span>

namespace kropla::pictures {

/// The domain cut open at the plane y = `y` [m], whole cells shown: the outer facets of all cells whose
/// centroid lies behind the plane. Cell and point arrays come along.
[[nodiscard]] vtkSmartPointer<vtkPolyData> opened(vtkUnstructuredGrid* grid, double y);

/// The cells cut by the plane y = `y` [m]: flat polygons. Cell and point arrays come along.
[[nodiscard]] vtkSmartPointer<vtkPolyData> section(vtkUnstructuredGrid* grid, double y);

/// Facets with their edges, every region in its colour: bodies warm, surroundings light.
[[nodiscard]] vtkSmartPointer<vtkActor> coloured_by_region(vtkPolyData* facets, double line_width);

/// Facets with faint edges, coloured by the point array `name`.
[[nodiscard]] vtkSmartPointer<vtkActor> coloured_by_field(vtkPolyData* facets, const char* name,
                                                          vtkScalarsToColors* colours);

/// Facets with their edges, coloured by the cell array aspect_ratio.
[[nodiscard]] vtkSmartPointer<vtkActor> coloured_by_quality(vtkPolyData* facets, vtkScalarsToColors* colours,
                                                            double line_width);

/// Facets in one colour, without edges.
[[nodiscard]] vtkSmartPointer<vtkActor> plain(vtkPolyData* facets, double red, double green, double blue);

/// Flat arrows that a view sees in front of everything: in the plane `plane`, dark.
[[nodiscard]] vtkSmartPointer<vtkActor> drawn_arrows(std::span<const Arrow> arrows, const CutPlane& plane,
                                                     double thickness, double in_front);

/// The lines in which the surfaces of the bodies meet the cut that `opened` made, or `section`.
[[nodiscard]] vtkSmartPointer<vtkActor> outlines_of_bodies(vtkPolyData* facets, double line_width);

/// Black over red to light yellow, even to the eye: the map "inferno" of van der Walt and Smith (CC0).
[[nodiscard]] vtkSmartPointer<vtkScalarsToColors> heat_colours(double least, double most);

/// Those of a scale of the report.
[[nodiscard]] vtkSmartPointer<vtkScalarsToColors> colours_of(const ColourScale& scale);

/// One colour per unit of R/r from 3 (perfect) to 10, pale to dark; darkest beyond.
[[nodiscard]] vtkSmartPointer<vtkScalarsToColors> quality_colours();

}  // namespace kropla::pictures
