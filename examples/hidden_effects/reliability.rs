//! The reliability plot: how often suggestions that were told with some probability were right.

use super::tally::Told;

/// Bounds of the probabilities that stand together.
pub(crate) const BOUNDS: [f64; 10] = [0.0, 0.01, 0.05, 0.2, 0.5, 0.8, 0.9, 0.97, 0.995, 1.0 + 1e-9];
/// Side of the square of the plot, and its margin, px.
const SIDE: f64 = 320.0;
const MARGIN: f64 = 56.0;

/// Suggestions whose probabilities stand together.
pub(crate) struct Bin {
    /// Least and greatest probability.
    pub range: [f64; 2],
    pub count: usize,
    /// Mean probability, shares with the right law, and with the right law and place.
    pub told: f64,
    pub law: f64,
    pub place: f64,
}

/// The bins that hold a suggestion.
pub(crate) fn bins(told: &[Told]) -> Vec<Bin> {
    let bin = |pair: &[f64]| {
        let list: Vec<&Told> = told.iter().filter(|t| t.probability >= pair[0] && t.probability < pair[1]).collect();
        let mean = |value: &dyn Fn(&Told) -> f64| list.iter().map(|t| value(t)).sum::<f64>() / list.len() as f64;
        (!list.is_empty()).then(|| Bin {
            range: [pair[0], pair[1].min(1.0)],
            count: list.len(),
            told: mean(&|t| t.probability),
            law: mean(&|t| f64::from(u8::from(t.law))),
            place: mean(&|t| f64::from(u8::from(t.place))),
        })
    };
    BOUNDS.windows(2).filter_map(bin).collect()
}

/// The plot as SVG: the share that was right over the mean probability told, bars of one standard deviation of a binomial share.
pub(crate) fn plot(told: &[Told]) -> String {
    let x = |p: f64| MARGIN + SIDE * p;
    let y = |p: f64| MARGIN / 2.0 + SIDE * (1.0 - p);
    let size = SIDE + 1.5 * MARGIN;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {size} {size}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"{size}\" height=\"{size}\" fill=\"white\"/>\n"
    );
    for step in 0..=5 {
        let p = f64::from(step) / 5.0;
        let percent = 20 * step;
        svg.push_str(&format!(
            "<path d=\"M{0:.1} {1:.1}H{2:.1}M{3:.1} {4:.1}V{5:.1}\" stroke=\"#ddd\" fill=\"none\"/>\n\
             <text x=\"{6:.1}\" y=\"{7:.1}\" text-anchor=\"end\">{percent}</text>\n\
             <text x=\"{3:.1}\" y=\"{8:.1}\" text-anchor=\"middle\">{percent}</text>\n",
            x(0.0),
            y(p),
            x(1.0),
            x(p),
            y(0.0),
            y(1.0),
            x(0.0) - 6.0,
            y(p) + 4.0,
            y(0.0) + 16.0
        ));
    }
    svg.push_str(&format!(
        "<path d=\"M{:.1} {:.1}L{:.1} {:.1}\" stroke=\"#888\" stroke-dasharray=\"4 3\"/>\n\
         <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">probability told, %</text>\n\
         <text transform=\"translate(16 {:.1}) rotate(-90)\" text-anchor=\"middle\">law and place right, %</text>\n",
        x(0.0),
        y(0.0),
        x(1.0),
        y(1.0),
        x(0.5),
        y(0.0) + 38.0,
        y(0.5)
    ));
    for bin in bins(told) {
        let spread = (bin.place * (1.0 - bin.place) / bin.count as f64).sqrt();
        let (at, right) = (x(bin.told), y(bin.place));
        // Near the right edge the count stands left of its point.
        let (anchor, beside) = if bin.told > 0.8 { ("end", -8.0) } else { ("start", 8.0) };
        svg.push_str(&format!(
            "<path d=\"M{at:.1} {:.1}V{:.1}\" stroke=\"#1f5fa8\" stroke-width=\"1.5\"/>\n\
             <circle cx=\"{at:.1}\" cy=\"{right:.1}\" r=\"4\" fill=\"#1f5fa8\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\" fill=\"#555\">{}</text>\n",
            y((bin.place - spread).max(0.0)),
            y((bin.place + spread).min(1.0)),
            at + beside,
            right - 6.0,
            bin.count
        ));
    }
    svg.push_str("</svg>\n");
    svg
}
