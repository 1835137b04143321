//! Pictures below each other in one file.

/// One SVG file of several, each of them one of this module's, from top to bottom.
#[must_use]
pub fn stack(pictures: &[String]) -> String {
    let size = |picture: &str, key: &str| {
        let (_, rest) = picture.split_once(&format!(" {key}=\"")).unwrap_or_default();
        rest.split('"').next().and_then(|number| number.parse::<f64>().ok()).unwrap_or(0.0)
    };
    let width = pictures.iter().map(|picture| size(picture, "width")).fold(0.0, f64::max);
    let (mut body, mut top) = (String::new(), 0.0);
    for picture in pictures {
        body.push_str(&picture.replacen("<svg ", &format!("<svg y=\"{top}\" "), 1));
        top += size(picture, "height");
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{top}\" viewBox=\"0 0 {width} {top}\">\n{body}</svg>\n"
    )
}
