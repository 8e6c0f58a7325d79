#include "cells.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <fstream>
#include <stdexcept>
#include <unordered_map>

namespace peers {
namespace {

[[noreturn]] void fail(const std::string& file, const std::string& what) {
    throw std::runtime_error(file + ": " + what);
}

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Cells read_vtu(const std::string& file) {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    if (reader->CanReadFile(file.c_str()) == 0) fail(file, "cannot be read as VTU");
    reader->SetFileName(file.c_str());
    reader->Update();
    vtkUnstructuredGrid* grid = reader->GetOutput();
    vtkDataArray* region = grid->GetCellData()->GetArray("region");
    Cells cells;
    cells.places.resize(static_cast<std::size_t>(grid->GetNumberOfPoints()));
    for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
        grid->GetPoint(i, cells.places[static_cast<std::size_t>(i)].data());
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
        vtkIdType count = 0;
        const vtkIdType* corners = nullptr;
        grid->GetCellPoints(c, count, corners);
        if (count != 4) fail(file, "holds cells that are not tets");
        std::array<int, 4> tet{};
        for (std::size_t i = 0; i < 4; ++i) tet[i] = static_cast<int>(corners[i]);
        cells.tets.push_back(tet);
        cells.region.push_back(region == nullptr ? 0 : static_cast<int>(region->GetComponent(c, 0)));
    }
    return cells;
}

/// Reads on until the line that is `word`.
void seek(std::istream& in, const std::string& file, const std::string& word) {
    std::string found;
    while (in >> found)
        if (found == word) return;
    fail(file, "has no " + word);
}

Cells read_msh(const std::string& file) {
    std::ifstream in(file);
    Cells cells;
    std::unordered_map<long, int> number;  // of a vertex, by its name in the file
    seek(in, file, "$Nodes");
    std::size_t vertices = 0, elements = 0;
    in >> vertices;
    for (std::size_t i = 0; i < vertices; ++i) {
        long name = 0;
        Point p{};
        in >> name >> p[0] >> p[1] >> p[2];
        number[name] = static_cast<int>(cells.places.size());
        cells.places.push_back(p);
    }
    seek(in, file, "$Elements");
    in >> elements;
    std::string line;
    std::getline(in, line);
    constexpr int tet_type = 4;
    for (std::size_t i = 0; i < elements && in; ++i) {
        long name = 0, corner = 0;
        int type = 0, tags = 0, tag = 0;
        in >> name >> type >> tags;
        std::array<int, 4> tet{};
        int entity = 0;
        for (int t = 0; t < tags; ++t) {
            in >> tag;
            if (t == 1) entity = tag;
        }
        if (type == tet_type) {
            for (int& v : tet) {
                in >> corner;
                v = number.at(corner);
            }
            cells.tets.push_back(tet);
            cells.region.push_back(entity);
        }
        std::getline(in, line);
    }
    if (!in) fail(file, "ends too early");
    return cells;
}

Cells read_medit(const std::string& file) {
    std::ifstream in(file);
    Cells cells;
    std::size_t count = 0;
    seek(in, file, "Vertices");
    in >> count;
    cells.places.resize(count);
    int reference = 0;
    for (Point& p : cells.places) in >> p[0] >> p[1] >> p[2] >> reference;
    seek(in, file, "Tetrahedra");
    in >> count;
    for (std::size_t i = 0; i < count && in; ++i) {
        std::array<int, 4> tet{};
        for (int& v : tet) {
            in >> v;
            --v;
        }
        in >> reference;
        cells.tets.push_back(tet);
        cells.region.push_back(reference);
    }
    if (!in) fail(file, "ends too early");
    return cells;
}

Cells read_tetgen(const std::string& file) {
    const std::string node_file = file.substr(0, file.size() - 3) + "node";
    std::ifstream nodes(node_file), in(file);
    Cells cells;
    std::size_t count = 0;
    int dimension = 0, attributes = 0, markers = 0, corners = 0, first = 0;
    nodes >> count >> dimension >> attributes >> markers;
    std::string rest;
    cells.places.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        int name = 0;
        Point& p = cells.places[i];
        nodes >> name >> p[0] >> p[1] >> p[2];
        if (i == 0) first = name;
        std::getline(nodes, rest);
    }
    if (!nodes) fail(node_file, "ends too early");
    in >> count >> corners >> attributes;
    for (std::size_t i = 0; i < count && in; ++i) {
        int name = 0;
        double region = 0;
        std::array<int, 4> tet{};
        in >> name;
        for (int& v : tet) {
            in >> v;
            v -= first;
        }
        if (attributes > 0) in >> region;
        std::getline(in, rest);
        cells.tets.push_back(tet);
        cells.region.push_back(static_cast<int>(region));
    }
    if (!in) fail(file, "ends too early");
    return cells;
}

void check(const std::string& file, const Cells& cells) {
    if (cells.tets.empty()) fail(file, "has no tets");
    for (const auto& tet : cells.tets)
        for (const int v : tet)
            if (v < 0 || at(v) >= cells.places.size()) fail(file, "names a vertex that is not there");
}

}  // namespace

Cells read_cells(const std::string& file) {
    Cells cells;
    if (file.ends_with(".vtu")) cells = read_vtu(file);
    else if (file.ends_with(".msh")) cells = read_msh(file);
    else if (file.ends_with(".mesh")) cells = read_medit(file);
    else if (file.ends_with(".ele")) cells = read_tetgen(file);
    else fail(file, "is of no format known here (.vtu, .msh, .mesh, .ele)");
    check(file, cells);
    return cells;
}

Point difference(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double length(const Point& a) { return std::sqrt(dot(a, a)); }

}  // namespace peers
