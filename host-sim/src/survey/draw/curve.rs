//! Curves over the steps of a run.

use plotters::prelude::*;

/// One named curve: a value for each step from 0.
pub struct Curve {
    /// Its name in the legend.
    pub name: String,
    /// Its values.
    pub values: Vec<f64>,
}

/// The curves as an SVG document; `title` says what the values are.
pub fn curves(title: &str, curves: &[Curve]) -> Result<String, String> {
    let steps = curves
        .iter()
        .map(|curve| curve.values.len())
        .max()
        .unwrap_or(1);
    let highest = curves
        .iter()
        .flat_map(|curve| &curve.values)
        .copied()
        .fold(0.0, f64::max);
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (800, 480)).into_drawing_area();
        let draw = || -> Result<(), Box<dyn std::error::Error>> {
            area.fill(&WHITE)?;
            let mut chart = ChartBuilder::on(&area)
                .caption(title, ("sans-serif", 20))
                .margin(12)
                .x_label_area_size(36)
                .y_label_area_size(60)
                .build_cartesian_2d(0.0..steps as f64, 0.0..highest.max(1e-9) * 1.05)?;
            chart
                .configure_mesh()
                .x_desc("steps")
                .light_line_style(WHITE)
                .draw()?;
            for (i, curve) in curves.iter().enumerate() {
                let [r, g, b] = super::ROBOT_COLOURS[(i + 4) % super::ROBOT_COLOURS.len()].0;
                let colour = RGBColor(r, g, b);
                let points = curve.values.iter().enumerate().map(|(x, y)| (x as f64, *y));
                chart
                    .draw_series(LineSeries::new(points, colour.stroke_width(2)))?
                    .label(&curve.name)
                    .legend(move |(x, y)| {
                        PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2))
                    });
            }
            if curves.len() > 1 {
                chart
                    .configure_series_labels()
                    .position(SeriesLabelPosition::LowerRight)
                    .border_style(BLACK)
                    .background_style(WHITE)
                    .draw()?;
            }
            area.present()?;
            Ok(())
        };
        draw().map_err(|error| error.to_string())?;
    }
    Ok(svg)
}
