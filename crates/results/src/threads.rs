//! The same work on many things, side by side.

use std::sync::atomic::{AtomicUsize, Ordering};

/// What `work` makes of each of `items`, in their order, on at most `threads` threads; `None`: as many as the machine has.
/// `work` gets the index as well.
pub fn parallel_map<T: Sync, R: Send>(
    items: &[T],
    threads: Option<u16>,
    work: impl Fn(usize, &T) -> R + Sync,
) -> Vec<R> {
    let available = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.map_or(available, usize::from).min(items.len());
    let next = AtomicUsize::new(0);
    let share = || {
        let mut own = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { return own };
            own.push((index, work(index, item)));
        }
    };
    let mut made: Vec<(usize, R)> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(share)).collect();
        let mut all = share();
        for other in others {
            match other.join() {
                Ok(own) => all.extend(own),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        all
    });
    made.sort_by_key(|(index, _)| *index);
    made.into_iter().map(|(_, made)| made).collect()
}

#[cfg(test)]
mod tests {
    use super::parallel_map;

    #[test]
    fn results_keep_the_order_of_their_items_on_any_number_of_threads() {
        let items: Vec<u64> = (0..100).collect();
        for threads in [Some(0), Some(1), Some(3), None] {
            let made = parallel_map(&items, threads, |index, item| (index, item * item));
            assert_eq!(made.len(), 100);
            assert!(
                made.iter().enumerate().all(|(k, (index, square))| *index == k && *square == (k * k) as u64)
            );
        }
    }
}
