// SPDX-License-Identifier: Apache-2.0
// Makes small 3MF files for tests and fuzz targets.
#pragma once

#include "support/zip_maker.h"

namespace frontmost::test {

inline const std::string model_part_name = "3D/3dmodel.model";
inline const std::string relationships =
    R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel" Target="/3D/3dmodel.model"/>
</Relationships>)";
/// Four vertices, four triangles.
inline const std::string tetrahedron =
    R"(<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/>
<vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/>
<triangle v1="1" v2="2" v3="3"/><triangle v1="0" v2="3" v3="2"/></triangles></mesh>)";

/// A model part: `attributes` of its first tag, and what is in that.
inline std::string model_of(const std::string& contents, const std::string& attributes = {}) {
  return R"(<?xml version="1.0" encoding="UTF-8"?>
<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
 xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
 xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06" )" +
         attributes + ">" + contents + "</model>";
}

/// A package whose model is `model`.
inline ZipMaker package_of(const std::string& model) {
  ZipMaker zip;
  zip.add("_rels/.rels", relationships).add(model_part_name, model);
  return zip;
}

}  // namespace frontmost::test
