//! Charts of many runs, as SVG and as PNG.

use std::io;

use image::RgbImage;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::paint::{INK, series_color, text};
use super::{DrawError, write_png};

/// Charts side by side that share a title and a legend.
#[derive(Clone, Debug)]
pub struct Chart {
    /// What is shown.
    pub title: String,
    /// One chart each, two in a row.
    pub panels: Vec<Panel>,
}

/// Axes and what is between them.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What distinguishes this panel.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// What the vertical axis counts, with its unit.
    pub y: String,
    /// What is drawn; the same names in every panel.
    pub series: Vec<Series>,
}

/// A horizontal axis: what it counts, with its unit.
#[derive(Clone, Debug)]
pub enum Axis {
    /// Equally spaced places with a label each; points are at 0, 1, …
    Places(String, Vec<String>),
    /// Numbers from 0.
    Numbers(String),
}

/// Points of one kind.
#[derive(Clone, Debug)]
pub struct Series {
    /// For the legend.
    pub name: String,
    /// Number of the colour.
    pub color: usize,
    /// How the points are drawn.
    pub style: Style,
    /// From left to right.
    pub points: Vec<Point>,
}

/// How points are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// A bar for each point, with an error bar.
    Bars,
    /// Dots with error bars, joined by lines.
    Dots,
    /// A curve in a band of confidence.
    Curve,
}

/// A value and its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Place on the horizontal axis.
    pub x: f64,
    /// Value.
    pub y: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end; not finite: there is no interval.
    pub high: f64,
}

impl Point {
    /// A value that nobody doubts.
    pub fn certain(x: f64, y: f64) -> Self {
        let (low, high) = (f64::NAN, f64::NAN);
        Self { x, y, low, high }
    }
}

const PANEL: (u32, u32) = (620, 400);
const HEAD: i32 = 44;
const LEGEND_LINE: i32 = 24;
/// Width of a character of the legend in pixels, about.
const CHARACTER: i32 = 8;
const GRID: RGBColor = RGBColor(225, 228, 233);

type Plane<'a, DB> = ChartContext<'a, DB, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

impl Chart {
    /// The chart as an SVG document.
    ///
    /// # Errors
    /// A chart that cannot be drawn.
    pub fn svg(&self) -> Result<String, DrawError> {
        let mut svg = String::new();
        self.draw(&SVGBackend::with_string(&mut svg, self.size()).into_drawing_area())?;
        Ok(svg)
    }

    /// Writes the chart as PNG.
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write_png(&self, to: impl io::Write) -> Result<(), DrawError> {
        let (width, height) = self.size();
        let mut picture = RgbImage::new(width, height);
        let size = (width, height);
        self.draw(&BitMapBackend::with_buffer(&mut picture, size).into_drawing_area())?;
        write_png(&picture, to)
    }

    fn columns(&self) -> usize {
        self.panels.len().clamp(1, 2)
    }

    fn size(&self) -> (u32, u32) {
        let width = match self.columns() {
            1 => PANEL.0 * 3 / 2,
            columns => PANEL.0 * columns as u32,
        };
        let rows = self.panels.len().div_ceil(self.columns()) as u32;
        (width, self.head(width as i32) as u32 + PANEL.1 * rows)
    }

    /// Height of title and legend.
    fn head(&self, width: i32) -> i32 {
        let lines = self
            .legend(width)
            .last()
            .map_or(0, |key| key.1.1 + LEGEND_LINE);
        lines.max(HEAD) + 4
    }

    /// Names and colours, and where they stand.
    fn legend(&self, width: i32) -> Vec<(&Series, (i32, i32))> {
        let (mut x, mut y) = (24, HEAD);
        let mut keys = Vec::new();
        for series in self.panels.first().map_or(&[][..], |panel| &panel.series) {
            let wide = 44 + CHARACTER * series.name.chars().count() as i32;
            if x + wide > width && x > 24 {
                (x, y) = (24, y + LEGEND_LINE);
            }
            keys.push((series, (x, y)));
            x += wide;
        }
        keys
    }

    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Result<(), DrawError>
    where
        DB::ErrorType: 'static,
    {
        area.fill(&WHITE)?;
        let width = self.size().0 as i32;
        // The font is fixed-width, 0.6 of its size a character; a long title shrinks.
        let room = (width - 48) as u32 * 10 / 6;
        let size = (room / self.title.chars().count().max(1) as u32).clamp(9, 19);
        area.draw(&Text::new(self.title.as_str(), (24, 14), text(size)))?;
        for (series, (x, y)) in self.legend(width) {
            let color = series_color(series.color);
            area.draw(&Rectangle::new(
                [(x, y + 2), (x + 18, y + 14)],
                color.filled(),
            ))?;
            area.draw(&Text::new(series.name.as_str(), (x + 26, y), text(15)))?;
        }
        let (_, below) = area.split_vertically(self.head(width));
        let rows = self.panels.len().div_ceil(self.columns());
        let areas = below.split_evenly((rows, self.columns()));
        for (panel, area) in self.panels.iter().zip(&areas) {
            panel.draw(area)?;
        }
        area.present()?;
        Ok(())
    }
}

impl Panel {
    /// The largest value, with its error bar unless that would dwarf the rest.
    fn highest(&self) -> f64 {
        let points = || self.series.iter().flat_map(|series| &series.points);
        let value = points().map(|point| point.y).fold(1.0, f64::max);
        let error = points()
            .map(|point| point.high)
            .filter(|high| high.is_finite());
        error.fold(value, f64::max).min(1.5 * value)
    }

    /// The end of the horizontal axis.
    fn farthest(&self) -> f64 {
        let points = self.series.iter().flat_map(|series| &series.points);
        points.map(|point| point.x).fold(1.0, f64::max)
    }

    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Result<(), DrawError>
    where
        DB::ErrorType: 'static,
    {
        let top = 1.05 * self.highest();
        let (label, across) = match &self.x {
            Axis::Places(label, places) => (label, -0.5..places.len() as f64 - 0.5),
            Axis::Numbers(label) => (label, 0.0..self.farthest()),
        };
        let place = |x: &f64| match &self.x {
            Axis::Numbers(_) => format!("{x:.0}"),
            Axis::Places(_, places) if x.fract() == 0.0 && *x >= 0.0 => {
                places.get(*x as usize).cloned().unwrap_or_default()
            }
            Axis::Places(..) => String::new(),
        };
        let mut plane = ChartBuilder::on(area)
            .caption(&self.title, text(16))
            .margin(14)
            .x_label_area_size(48)
            .y_label_area_size(76)
            .build_cartesian_2d(across, 0.0..top)?;
        let mut mesh = plane.configure_mesh();
        if let Axis::Places(_, places) = &self.x {
            mesh.disable_x_mesh().x_labels(2 * places.len() + 1);
        }
        mesh.x_desc(label)
            .y_desc(&self.y)
            .axis_desc_style(text(15))
            .label_style(text(13))
            .axis_style(INK.stroke_width(1))
            .bold_line_style(GRID.stroke_width(1))
            .light_line_style(TRANSPARENT)
            .x_label_formatter(&place)
            .y_label_formatter(&|y| format!("{y:.0}"))
            .draw()?;
        for (number, series) in self.series.iter().enumerate() {
            series.draw(&mut plane, number, self.series.len(), top)?;
        }
        Ok(())
    }
}

impl Series {
    /// Draws this as number `number` of `count` series, below `top`.
    fn draw<DB: DrawingBackend>(
        &self,
        plane: &mut Plane<'_, DB>,
        number: usize,
        count: usize,
        top: f64,
    ) -> Result<(), DrawError>
    where
        DB::ErrorType: 'static,
    {
        let color = series_color(self.color);
        let middle = number as f64 - (count as f64 - 1.0) / 2.0;
        match self.style {
            Style::Bars => {
                let width = 0.8 / count as f64;
                plane.draw_series(self.points.iter().map(|point| {
                    let left = point.x + (middle - 0.5) * width;
                    Rectangle::new([(left, 0.0), (left + 0.9 * width, point.y)], color.filled())
                }))?;
                self.draw_errors(plane, INK, (middle - 0.05) * width, top)
            }
            Style::Dots => {
                // Side by side, so that no error bar hides another.
                let shift = 0.05 * middle;
                let shifted = || self.points.iter().map(|point| (point.x + shift, point.y));
                plane.draw_series(LineSeries::new(shifted(), color.stroke_width(2)))?;
                plane.draw_series(shifted().map(|at| Circle::new(at, 3, color.filled())))?;
                self.draw_errors(plane, color, shift, top)
            }
            Style::Curve => {
                let lower = self.points.iter().map(|point| (point.x, point.low));
                let upper = self.points.iter().rev().map(|point| (point.x, point.high));
                let band: Vec<_> = upper.chain(lower).filter(|at| at.1.is_finite()).collect();
                plane.draw_series([Polygon::new(band, color.mix(0.15))])?;
                let line = self.points.iter().map(|point| (point.x, point.y));
                plane.draw_series(LineSeries::new(line, color.stroke_width(2)))?;
                Ok(())
            }
        }
    }

    fn draw_errors<DB: DrawingBackend>(
        &self,
        plane: &mut Plane<'_, DB>,
        color: RGBColor,
        shift: f64,
        top: f64,
    ) -> Result<(), DrawError>
    where
        DB::ErrorType: 'static,
    {
        let sure = self.points.iter().filter(|point| point.high.is_finite());
        plane.draw_series(sure.map(|point| {
            let (x, style) = (point.x + shift, color.stroke_width(1));
            ErrorBar::new_vertical(x, point.low, point.y, point.high.min(top), style, 7)
        }))?;
        Ok(())
    }
}
