//! Which element of a rail carries a place.

use super::element::{LocalPlace, RailElement};
use crate::error::Error;

/// Rounding allowed in coordinates, relative to the largest coordinate of the rail.
const ROUNDING: f64 = 1e-12;

/// One rail: its elements by increasing x.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    pub rail: usize,
    /// Rounding allowed in its coordinates, length.
    slack: f64,
    spans: Vec<Span>,
    index: BinIndex,
}

/// The extent of one element on its rail.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// First and last coordinate.
    pub x: [f64; 2],
    /// What rounding took from them.
    pub rest: [f64; 2],
    /// 1/(extent in x).
    pub scale: f64,
    /// Length of the member, and whether it runs against the rail.
    pub length: f64,
    pub reversed: bool,
    /// Index of the element.
    pub element: usize,
    /// Whether the preceding element, listed earlier, carries the place `x[0]`.
    yields: bool,
}

impl Span {
    /// The place of x, taken within the element.
    #[inline]
    pub fn local(&self, x: f64) -> LocalPlace {
        LocalPlace::by_distances(
            [
                (x - self.x[0]) - self.rest[0],
                (self.x[1] - x) + self.rest[1],
            ],
            self.scale,
        )
    }
}

/// Divides a rail into as many equal bins as it has elements, and counts the elements that begin in each: a
/// search then looks at few of them.
#[derive(Clone, Debug)]
struct BinIndex {
    start: f64,
    scale: f64,
    /// Number of elements that begin before bin k; one more than bins.
    before: Vec<u32>,
}

impl BinIndex {
    fn new(spans: &[Span]) -> BinIndex {
        let bins = spans.len();
        let start = spans[0].x[0];
        let mut index = BinIndex {
            start,
            scale: bins as f64 / (spans[bins - 1].x[1] - start),
            before: vec![0; bins + 1],
        };
        for span in spans {
            let bin = index.bin(span.x[0]);
            index.before[bin + 1] += 1;
        }
        for k in 0..bins {
            index.before[k + 1] += index.before[k];
        }
        index
    }

    /// Bin of x; it never decreases with x.
    #[inline]
    fn bin(&self, x: f64) -> usize {
        let bin = ((x - self.start) * self.scale) as i32;
        (bin.max(0) as usize).min(self.before.len() - 2)
    }

    /// Number of elements that begin at x or before.
    #[inline]
    fn begun(&self, spans: &[Span], x: f64) -> usize {
        let bin = self.bin(x);
        let [low, high] = [self.before[bin] as usize, self.before[bin + 1] as usize];
        let here = &spans[low..high];
        // Mostly there is one, which needs no search.
        if let [one] = here {
            low + usize::from(one.x[0] <= x)
        } else {
            low + here.partition_point(|span| span.x[0] <= x)
        }
    }
}

impl Track {
    /// Sorts elements by rail and coordinate.
    ///
    /// # Errors
    /// Elements of one rail that overlap by more than rounding.
    pub fn all(elements: &[RailElement]) -> Result<Vec<Track>, Error> {
        let mut order: Vec<usize> = (0..elements.len()).collect();
        order.sort_by(|&a, &b| {
            let (p, q) = (&elements[a], &elements[b]);
            p.rail
                .cmp(&q.rail)
                .then(p.x[0].total_cmp(&q.x[0]))
                .then(a.cmp(&b))
        });
        order
            .chunk_by(|&a, &b| elements[a].rail == elements[b].rail)
            .map(|same| Track::new(elements, same))
            .collect()
    }

    /// One rail, whose elements `same` are sorted by coordinate.
    fn new(elements: &[RailElement], same: &[usize]) -> Result<Track, Error> {
        let rail = elements[same[0]].rail;
        let largest = same
            .iter()
            .flat_map(|&k| elements[k].x)
            .fold(0.0_f64, |a, x| a.max(x.abs()));
        let slack = ROUNDING * largest;
        let span = |element: usize, yields| {
            let RailElement { x, length, .. } = elements[element];
            let reversed = elements[element].is_reversed();
            Span {
                x,
                rest: [0.0; 2],
                scale: 1.0 / (x[1] - x[0]),
                length,
                reversed,
                element,
                yields,
            }
        };
        let mut spans = vec![span(same[0], false)];
        for pair in same.windows(2) {
            let (before, element) = (pair[0], pair[1]);
            let (end, start) = (elements[before].x[1], elements[element].x[0]);
            if end > start + slack {
                return Err(Error::Overlap {
                    rail,
                    first: before,
                    second: element,
                    x: start,
                });
            }
            spans.push(span(element, end >= start && before < element));
        }
        Ok(Track {
            rail,
            slack,
            index: BinIndex::new(&spans),
            spans,
        })
    }

    /// Sets what rounding took from the coordinates of the ends of each element.
    pub fn set_rests(&mut self, rests: &[[f64; 2]]) {
        for span in &mut self.spans {
            span.rest = rests[span.element];
        }
    }

    /// The element that carries coordinate x.
    ///
    /// # Errors
    /// No element there.
    #[inline(always)]
    pub fn find(&self, x: f64) -> Result<&Span, Error> {
        let Track {
            slack,
            spans,
            index,
            ..
        } = self;
        let after = index.begun(spans, x);
        if let Some(k) = after.checked_sub(1) {
            let span = &spans[k];
            if x == span.x[0] && span.yields {
                return Ok(&spans[k - 1]);
            }
            if x <= span.x[1] + slack {
                return Ok(span);
            }
        }
        match spans.get(after) {
            Some(span) if span.x[0] - x <= *slack => Ok(span),
            _ => Err(Error::OffRail { rail: self.rail, x }),
        }
    }

    /// Ends of the elements, increasing, each once.
    pub fn breaks(&self) -> Vec<f64> {
        let mut out: Vec<f64> = self.spans.iter().flat_map(|span| span.x).collect();
        out.sort_by(f64::total_cmp);
        out.dedup_by(|b, a| *b - *a <= self.slack);
        out
    }

    /// First and last coordinate.
    pub fn range(&self) -> [f64; 2] {
        [self.spans[0].x[0], self.spans[self.spans.len() - 1].x[1]]
    }
}
