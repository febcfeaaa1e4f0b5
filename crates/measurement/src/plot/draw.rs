//! Drawing of plots.

use std::fmt::Write as _;

use etendue_io::escape::escaped;
use glam::DVec2;

use super::{AxisRange, BOTTOM, Colour, HEIGHT, LEFT, Legend, Mark, Plot, RIGHT, ROW, Series, TOP, WIDTH};

/// Colours that people with colour-blindness can distinguish (Okabe & Ito 2008).
const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00", "#56b4e9"];

/// Plots one below the other in one SVG file.
#[must_use]
pub fn svg(plots: &[Plot]) -> String {
    let drawings: Vec<_> = plots.iter().map(Drawing::new).collect();
    let height: f64 = drawings.iter().map(Drawing::height).sum();
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {WIDTH} {height}\" \
         font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    let mut top = 0.0;
    for drawing in &drawings {
        let _ = writeln!(out, "<g transform=\"translate(0 {top})\">");
        drawing.draw(&mut out);
        out += "</g>\n";
        top += drawing.height();
    }
    out + "</svg>\n"
}

struct Drawing<'a> {
    plot: &'a Plot,
    x: AxisRange,
    y: AxisRange,
    legend: Legend,
}

impl<'a> Drawing<'a> {
    fn new(plot: &'a Plot) -> Self {
        let points = || plot.series.iter().flat_map(|s| &s.points);
        let mut drawing = Self {
            plot,
            x: AxisRange::new(&plot.x, points().map(|p| p[0])),
            y: AxisRange::new(&plot.y, points().flat_map(|p| [p[1] - p[2], p[1] + p[2]])),
            legend: Legend::below(plot),
        };
        if let Some(legend) = drawing.legend.in_a_corner(&drawing.drawn()) {
            drawing.legend = legend;
        }
        drawing
    }

    /// Occupied positions: points, ends of error bars, and points along lines some pixels apart.
    fn drawn(&self) -> Vec<(f64, f64)> {
        let mut drawn = Vec::new();
        for series in &self.plot.series {
            let placed: Vec<_> = series.points.iter().filter_map(|p| self.place(p[0], p[1])).collect();
            let ends = series.points.iter().flat_map(|[x, y, half]| [y - half, y + half].map(|y| self.place(*x, y)));
            drawn.extend(ends.flatten());
            if series.mark != Mark::Points {
                let between = |pair: &[(f64, f64)]| {
                    let ((x, y), (to_x, to_y)) = (pair[0], pair[1]);
                    (0..64).map(move |i| f64::from(i) / 64.0).map(move |t| (x + t * (to_x - x), y + t * (to_y - y)))
                };
                drawn.extend(placed.windows(2).flat_map(between));
            }
            drawn.extend(placed);
        }
        drawn
    }

    fn draw(&self, out: &mut String) {
        self.frame(out);
        for (i, series) in self.plot.series.iter().enumerate() {
            self.series(out, series, colour(i, series));
        }
        self.draw_legend(out);
    }

    fn place(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        let (x, y) = (self.x.place(x)?, self.y.place(y)?);
        Some((LEFT + x * (WIDTH - LEFT - RIGHT), HEIGHT - BOTTOM - y * (HEIGHT - TOP - BOTTOM)))
    }

    fn frame(&self, out: &mut String) {
        let (right, bottom) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        for (place, text) in self.x.ticks() {
            let x = LEFT + place * (right - LEFT);
            line(out, DVec2::new(x, TOP), DVec2::new(x, bottom), "#dddddd");
            label(out, x, bottom + 18.0, "middle", &text);
        }
        for (place, text) in self.y.ticks() {
            let y = bottom - place * (bottom - TOP);
            line(out, DVec2::new(LEFT, y), DVec2::new(right, y), "#dddddd");
            label(out, LEFT - 8.0, y + 4.5, "end", &text);
        }
        let (width, height) = (right - LEFT, bottom - TOP);
        let _ = writeln!(
            out,
            "<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{width}\" height=\"{height}\" fill=\"none\" stroke=\"#444444\"/>"
        );
        label(out, 0.5 * (LEFT + right), HEIGHT - 18.0, "middle", &self.plot.x.label);
        label(out, 0.5 * (LEFT + right), 24.0, "middle", &self.plot.title);
        let middle = 0.5 * (TOP + bottom);
        let text = escaped(&self.plot.y.label);
        let _ = writeln!(
            out,
            "<text transform=\"translate(20 {middle}) rotate(-90)\" text-anchor=\"middle\">{text}</text>"
        );
    }

    fn series(&self, out: &mut String, series: &Series, colour: &str) {
        let placed = series.points.iter().filter_map(|p| self.place(p[0], p[1]));
        match series.mark {
            Mark::Points => placed.for_each(|(x, y)| {
                let _ = writeln!(out, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3\" fill=\"{colour}\"/>");
            }),
            Mark::Line | Mark::Broken => {
                let path: Vec<String> = placed.map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
                let dashes = if series.mark == Mark::Broken { " stroke-dasharray=\"6 4\"" } else { "" };
                let path = path.join(" ");
                let _ = writeln!(
                    out,
                    "<polyline points=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\"{dashes}/>"
                );
            }
        }
        for [x, y, half] in series.points.iter().filter(|p| p[2] > 0.0) {
            if let (Some(low), Some(high)) = (self.place(*x, y - half), self.place(*x, y + half)) {
                line(out, low.into(), high.into(), colour);
            }
        }
    }

    /// Height of the plot, including the legend if the curves leave no corner for it.
    fn height(&self) -> f64 {
        HEIGHT + if self.legend.is_below { self.legend.height } else { 0.0 }
    }

    fn draw_legend(&self, out: &mut String) {
        let named = self.plot.series.iter().enumerate().filter(|(_, s)| !s.name.is_empty());
        for (row, (i, series)) in named.enumerate() {
            let (x, y) = (self.legend.left, self.legend.top + ROW * (row as f64 + 0.8));
            let colour = colour(i, series);
            match series.mark {
                Mark::Points => {
                    let _ = writeln!(out, "<circle cx=\"{}\" cy=\"{}\" r=\"3\" fill=\"{colour}\"/>", x + 10.0, y - 4.5);
                }
                _ => line(out, DVec2::new(x, y - 4.5), DVec2::new(x + 20.0, y - 4.5), colour),
            }
            label(out, x + 28.0, y, "start", &series.name);
        }
    }
}

/// The colour of the ith series of a plot.
fn colour(i: usize, series: &Series) -> &'static str {
    let place = match series.colour {
        Some(Colour::Blue) => 0,
        Some(Colour::Red) => 1,
        None => i % COLOURS.len(),
    };
    COLOURS[place]
}

fn line(out: &mut String, from: DVec2, to: DVec2, colour: &str) {
    let _ = writeln!(
        out,
        "<line x1=\"{:.2}\" y1=\"{:.2}\" x2=\"{:.2}\" y2=\"{:.2}\" stroke=\"{colour}\"/>",
        from.x, from.y, to.x, to.y
    );
}

fn label(out: &mut String, x: f64, y: f64, anchor: &str, text: &str) {
    let _ = writeln!(out, "<text x=\"{:.2}\" y=\"{:.2}\" text-anchor=\"{anchor}\">{}</text>", x, y, escaped(text));
}

#[cfg(test)]
mod tests {
    use super::super::Axis;
    use super::*;

    #[test]
    fn the_legend_stands_where_nothing_is_drawn() {
        let plot = |points: &[(f64, f64)]| Plot {
            title: String::new(),
            x: Axis::linear("x"),
            y: Axis::linear("y"),
            series: vec![Series::new("a curve with a name", Mark::Line, points.iter().copied())],
        };
        let (rising, all_over) =
            (plot(&[(0.0, 0.0), (1.0, 1.0)]), plot(&[(0.0, 1.0), (0.1, 0.0), (0.9, 1.0), (1.0, 0.0)]));
        let in_corner = Drawing::new(&rising);
        assert!(!in_corner.legend.is_below && in_corner.legend.left < 200.0 && in_corner.height() == HEIGHT);
        let crossed = Drawing::new(&all_over);
        let free = |drawing: &Drawing<'_>| !drawing.drawn().iter().any(|(x, y)| drawing.legend.covers_point(*x, *y));
        assert!(free(&in_corner) && free(&crossed));
        let zigzag: Vec<_> = (0..40).map(|i| (f64::from(i), f64::from(i % 2))).collect();
        let below = plot(&zigzag);
        assert!(Drawing::new(&below).legend.is_below && Drawing::new(&below).height() > HEIGHT);
    }

    #[test]
    fn a_plot_holds_its_points_and_its_texts() {
        let plot = Plot {
            title: "a < b".to_owned(),
            x: Axis::linear("x"),
            y: Axis::log("y"),
            series: vec![
                Series::with_errors("measured", Mark::Points, [(0.0, 1.0, 0.5), (1.0, 10.0, 0.0), (2.0, -1.0, 0.0)]),
                Series::new("model", Mark::Line, [(0.0, 1.0), (1.0, 10.0)]),
            ],
        };
        let text = svg(&[plot]);
        // Two points that a logarithmic axis can show, and the legend's.
        assert_eq!(text.matches("<circle").count(), 3);
        assert_eq!(text.matches("<polyline").count(), 1);
        assert!(text.contains("a &lt; b") && text.contains(">measured<") && text.ends_with("</svg>\n"));
    }
}
