// Figures of an HTML page: the place where a chart is drawn, its specification and its data.
#pragma once

#include <map>
#include <string>

#include "reports/figures/document.hpp"

namespace odobench {

// <figure id="figure-ID"> with a place of about the chart's height, so that the page does not jump when it is
// drawn.
std::string render_html_figure(const Figure& figure, int number);

// <script type="application/json" data-figure=ID>: the specification, its data by name. Throws
// std::invalid_argument naming figure and data set when `datasets` lacks one.
std::string render_html_specification(const Figure& figure,
                                      const std::map<std::string, std::string>& datasets);
// <script type="application/json" data-dataset=NAME>: the text as a JSON string.
std::string render_html_dataset(const std::string& name, const std::string& text);

// The height in px that a specification will about take: heights of its views and room for axes, titles and
// legends.
int estimated_height(const nlohmann::json& spec);

}  // namespace odobench
